// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/write_motion.h"

#include "app/motion/foot_contacts.h"
#include "reconstruct/tags/tag_tracks.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/motion/npz.h"

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
      estimate.uncertainty, foot_contacts(estimate.motion), start_s};
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
