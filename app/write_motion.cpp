// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/write_motion.h"

#include "app/foot_contacts.h"
#include "reconstruct/tag_tracks.h"
#include "recordings/bvh.h"
#include "recordings/gltf.h"
#include "recordings/mannequin.h"
#include "recordings/marker_file.h"
#include "recordings/motion_tables.h"
#include "recordings/npz.h"

namespace marey::app {

Status write_motion(const std::filesystem::path& folder,
                    const EstimatedMotion& estimate,
                    const Proportions& proportions,
                    std::optional<double> start_s) {
  if (const Status ok =
          recordings::write_joints_csv(folder / "joints.csv", estimate, start_s);
      !ok) {
    return ok;
  }
  if (const Status ok =
          recordings::write_segments_csv(folder / "segments.csv", estimate, start_s);
      !ok) {
    return ok;
  }
  if (const Status ok = recordings::write_bvh(folder / "motion.bvh", estimate.motion);
      !ok) {
    return ok;
  }
  const recordings::NpzExtras extras{
      estimate.doubt, foot_contacts(estimate.motion), start_s};
  if (const Status ok =
          recordings::write_npz(folder / "motion.npz", estimate.motion, extras);
      !ok) {
    return ok;
  }
  return recordings::write_character(folder / "motion.glb",
                                     estimate.motion.skeleton,
                                     recordings::make_mannequin_mesh(proportions),
                                     &estimate.motion);
}

Status write_tag_markers(const std::filesystem::path& folder,
                         const Body& body,
                         const reconstruct::SolvedTrial& solved) {
  recordings::MarkerFile markers;
  markers.tracks = reconstruct::tag_tracks(body, solved);
  markers.axes.up = recordings::FileAxis::kPlusZ;
  const Status written = recordings::write_markers(folder / "markers.c3d", markers);
  if (!written) return written;
  markers.axes.up = recordings::FileAxis::kPlusY;
  return recordings::write_markers(folder / "markers.trc", markers);
}

}  // namespace marey::app
