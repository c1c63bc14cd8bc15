//! The order of the house, read from its sources: folders of the engine import downwards only, no files import each other in a circle, what is
//! one of many (a potential, a law, a field) is one file and a line in the list of its folder, and the middle of the house only shrinks.

mod circles;
mod floors;
mod imports;
mod lists;
mod middle;
mod reading;
