mod bodies;
mod errors;
mod exactness;
mod loads;
mod published;
mod schemes;
mod selection;
