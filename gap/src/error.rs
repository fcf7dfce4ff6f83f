//! What can go wrong.

/// Why there is no analysis.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum GapError {
    /// The wheels cannot drive the robot.
    #[error("robot.toml: {0}")]
    Robot(String),
    /// No link can be compared.
    #[error("the logs hold no two neighbouring signals to compare; log counts with duties or camera poses")]
    NothingToCompare,
    /// The camera saw the robot too rarely.
    #[error(
        "no second of the logs has four camera poses, which counts are compared with, as where only the ends of a run were \
         measured; log every frame of the camera, or duties"
    )]
    FewPoses,
    /// There would be something to compare if robot.toml said more.
    #[error(
        "nothing can be compared before robot.toml says what the duties need: {0}; `racbot init --log` asks for it"
    )]
    Lacking(String),
    /// A file could not be written.
    #[error("{0}")]
    Write(String),
    /// A log could not be read again.
    #[error("{0}")]
    Log(runs::RunError),
    /// A user's effect is wrong.
    #[error("{0}")]
    Effect(String),
}
