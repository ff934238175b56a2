//! The Gaussian process against an independent dense solve: nalgebra's LU decomposition in double
//! precision, with the covariance written out here.

mod dense;
mod learning;
mod likelihood;
mod mean;
mod optimisers;
mod posterior;
