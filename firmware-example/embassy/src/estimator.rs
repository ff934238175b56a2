//! What a pose estimator would deliver, and the channel that it delivers through.

use cobra_agreement::vectors::Points;
use cobra_firmware_app::score::{POSES, is_sound};
use cobra_infer::{Correspondence, Pose};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;

/// In this order: a pose, its points, its end, the next pose.
#[derive(Clone, Debug)]
pub(crate) enum Message {
    /// A pose to be judged, and what it is called.
    Pose(&'static str, Pose),
    /// A correspondence of the pose.
    Point(Correspondence),
    /// The pose has no more points.
    EndOfPose,
    /// There are no more poses. A camera would never send it.
    EndOfStream,
}

/// Few, because the estimator waits while it is full: its depth is RAM, and buys only that the two
/// need not keep step.
const DEPTH: usize = 8;

/// Behind a critical section, so that an interrupt could send as well.
pub(crate) static MESSAGES: Channel<CriticalSectionRawMutex, Message, DEPTH> = Channel::new();

/// Poses, and what they are called.
pub(crate) type Poses = [(&'static str, Pose); POSES.len()];

/// Sends every pose with all of its points.
#[embassy_executor::task]
pub(crate) async fn run(points: Points<'static>, poses: Poses) {
    for (title, pose) in poses {
        MESSAGES.send(Message::Pose(title, pose)).await;
        for correspondence in points.correspondences().filter(is_sound) {
            MESSAGES.send(Message::Point(correspondence)).await;
        }
        MESSAGES.send(Message::EndOfPose).await;
    }
    MESSAGES.send(Message::EndOfStream).await;
}
