//! Heat and species through bonds, against closed forms.

mod accounts;
mod bars;
mod contact;
mod expand;
mod flow;
mod modes;
mod repeat;
mod sample;
mod stages;
