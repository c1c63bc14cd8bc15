mod bodies;
mod probe;
