//! Where a thing should stand: in the base frame, where it was taught, or on a fixture.
//!
//! A fixture stands on one that the file describes before it, so that no row of them has no end.

use super::build::{Builder, joints, pose_of};
use super::file::PlaceFile;
use super::{CellCode, CellError, FixtureSpec, On};
use crate::kinematics::forward;
use obverse_geometry::Pose;
use toml::Spanned;

/// Where a thing should stand.
pub(super) struct Stand {
    /// In the base frame.
    pub(super) pose: Pose,
    pub(super) on: Option<On>,
}

impl Stand {
    /// What is at a pose in the frame of this.
    pub(super) fn inside(&self, inner: &Pose) -> (Pose, Option<On>) {
        let on = self.on.map(|on| On { place: on.place.compose(inner), ..on });
        (self.pose.compose(inner), on)
    }
}

impl Builder<'_> {
    /// Where a place is; without a fixture it is in the base frame. What was taught was taught
    /// where it should be, and moves with its fixture from there.
    pub(super) fn stand(
        &self,
        on: Option<&Spanned<String>>,
        file: &PlaceFile,
        tcp: &Pose,
        fixtures: &[FixtureSpec],
    ) -> Result<Stand, CellError> {
        let place = pose_of(file.xyz_mm, file.rotation_vector_deg);
        let taught = file.taught_at_rad.as_ref();
        let taught = taught.map(|taught| forward(&joints(taught)).compose(tcp).compose(&place));
        let Some(name) = on else {
            return Ok(Stand { pose: taught.unwrap_or(place), on: None });
        };
        let fixture = self.fixture_before(name, fixtures)?;
        let base = &fixtures[fixture].pose;
        let place = taught.map_or(place, |taught| base.inverse().compose(&taught));
        Ok(Stand { pose: base.compose(&place), on: Some(On { fixture, place }) })
    }

    fn fixture_before(
        &self,
        name: &Spanned<String>,
        fixtures: &[FixtureSpec],
    ) -> Result<usize, CellError> {
        let found = fixtures.iter().position(|fixture| &fixture.name == name.get_ref());
        found.ok_or_else(|| {
            let message = format!(
                "there is no fixture `{}` before this: a thing stands on a fixture that the file \
                 describes, and a fixture on one that stands above it in the file",
                name.get_ref()
            );
            self.error(name, message).of(CellCode::UnknownName)
        })
    }
}
