//! Tests of newton_path on hand-made systems of few unknowns.

mod derivatives;
mod invariance;
mod one_block;
mod requests;
mod responses;
mod small_functions;
mod snap_through;
mod springs;
mod stack;
mod tilting;
mod tipping;
mod two_degrees;
mod yielding;
