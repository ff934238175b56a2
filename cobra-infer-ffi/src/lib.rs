//! The C interface of `cobra-infer`: a static library, and the header `include/cobra_infer.h`.
//!
//! `docs/C.md` is its document: how to build and link it, a complete program, the status numbers.
//! Nothing is computed here. Arguments are checked and turned into `cobra-infer`'s types, and what
//! that crate answers is turned into C's, so that C gets the same bits as Rust.
//!
//! | module | owns |
//! |---|---|
//! | [`status`] | the status numbers, their texts, and which error each stands for |
//! | [`strings`] | the texts as C asks for them |
//! | [`types`] | the structures and enumerations of the interface |
//! | [`mod@pointer`] | what is checked of a pointer before it is used |
//! | [`template`] | loading a template and asking about it |
//! | [`camera`] | checks of lens distortion, repair of rotations |
//! | [`scorer`] | scoring one pose |
//! | [`mod@depth`] | checking one pose against a depth image; what it needs and tells: [`depth_types`] |
//! | [`layout`] | how much memory handles need |
//! | `panic` | the panic handler of bare metal |
#![cfg_attr(target_os = "none", no_std)]
#![cfg_attr(
    not(test),
    deny(
        clippy::indexing_slicing,
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::unreachable
    )
)]

pub mod camera;
pub mod depth;
pub mod depth_types;
pub mod layout;
#[cfg(target_os = "none")]
mod panic;
pub mod pointer;
pub mod scorer;
pub mod status;
pub mod strings;
pub mod template;
pub mod types;

#[cfg(test)]
mod tests;
