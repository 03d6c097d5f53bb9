//! Parts by themselves.

mod facets;
mod image;
mod legendre;
mod moments;
mod space;
mod spread;
mod tree;
