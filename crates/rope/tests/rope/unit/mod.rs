//! Parts by themselves.

mod beam_element;
mod beam_strain;
mod cable_element;
mod chain_element;
mod curve_pair_blend;
mod curve_pair_passage;
mod curve_pair_side;
mod hermite;
mod path_read;
mod path_sample;
mod quaternion;
mod section;
