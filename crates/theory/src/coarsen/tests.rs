mod bodies;
mod errors;
mod exactness;
mod schemes;
mod selection;
