//! Scores 6D object poses against a Gaussian-process shape template.
#![no_std]
#![forbid(unsafe_code)]
