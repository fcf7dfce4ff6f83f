//! From rust-hdl blocks to the files in `generated/`.
