//! Somebody else's answers: closed forms, published numbers, independent programs.

mod arch;
mod cap;
mod cohesive;
mod compare;
mod contact;
mod crushing;
mod elements;
mod event;
mod extreme_strengths;
mod finite;
mod flow_rule;
mod force_method;
mod newton;
mod optimise;
mod orthotropic;
mod path_certificate;
mod paths_read;
mod plastic;
mod semicircle;
mod settlements;
mod snap_through;
mod softening;
mod statuses;
mod walls;
