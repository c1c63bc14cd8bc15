mod bodies;
mod errors;
mod exactness;
mod loads;
mod motion;
mod published;
mod schemes;
mod selection;
