// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture_output.h"

#include <algorithm>
#include <cmath>

#include "reconstruct/point_sigma.h"
#include "reconstruct/sightings.h"

namespace marey::reconstruct {
namespace {

// A marker that was never measured to stray less is not trusted to do so. [m]
constexpr double kLeastKnownStray_m = 0.001;

bool is_finite(const MarkerSample& sample) {
  const glm::dvec3& p = sample.p_in_world;
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) &&
         std::isfinite(sample.sigma_m);
}

}  // namespace

MarkerModel to_marker_model(const Body& body) {
  MarkerModel model;
  model.lengths = lengths_of(body.proportions);
  model.body = frame_of(body);
  for (const PlacedMarker& marker : body.markers) {
    const HumanBone bone = solved_segment(marker.segment);
    glm::dvec3 p = marker.p_in_segment;
    // Toes move with their foot, in whose frame theirs begins farther on.
    if (bone != marker.segment) p += body.proportions[marker.segment];
    model.markers.push_back(
        {bone, eigen(p), std::max(kLeastKnownStray_m, marker.stray_m)});
  }
  return model;
}

MarkerColumns find_columns(const Body& body, std::span<const std::string> labels) {
  MarkerColumns columns;
  for (const PlacedMarker& marker : body.markers) {
    const auto it = std::find(labels.begin(), labels.end(), marker.label);
    columns.push_back(it == labels.end()
                          ? std::nullopt
                          : std::optional(static_cast<std::size_t>(it - labels.begin())));
  }
  return columns;
}

void collect(std::span<const std::optional<MarkerSample>> frame,
             const MarkerColumns& columns,
             std::vector<SeenMarker>& out) {
  out.clear();
  for (std::size_t m = 0; m < columns.size(); ++m) {
    if (!columns[m] || !frame[*columns[m]]) continue;
    const MarkerSample& sample = *frame[*columns[m]];
    if (!is_finite(sample)) continue;
    out.push_back({m, eigen(sample.p_in_world), static_cast<double>(sample.sigma_m)});
  }
}

BoneSources sources_of(const MarkerModel& model,
                       std::span<const std::optional<MarkerSample>> frame,
                       const MarkerColumns& columns) {
  BoneSources sources;
  sources.fill(Source::kInferred);
  for (std::size_t m = 0; m < columns.size(); ++m) {
    if (!columns[m] || !frame[*columns[m]]) continue;
    Source& source = sources[index(model.markers[m].bone)];
    source = std::min(source, frame[*columns[m]]->source);
  }
  sources[index(HumanBone::kLeftToes)] = sources[index(HumanBone::kLeftFoot)];
  sources[index(HumanBone::kRightToes)] = sources[index(HumanBone::kRightFoot)];
  return sources;
}

void to_pose(const UnfoldedPosture& unfolded, const Skeleton& skeleton, Pose& out) {
  out.parent_from_joint.resize(skeleton.joints.size());
  const Eigen::Vector3d& root = unfolded.origin(HumanBone::kHips);
  out.root_in_world = {root.x(), root.y(), root.z()};
  for (const HumanBone bone : human_bones()) {
    const auto up = parent(bone);
    const Eigen::Matrix3d own =
        up ? Eigen::Matrix3d(unfolded.rotation(*up).transpose() * unfolded.rotation(bone))
           : unfolded.rotation(bone);
    const Eigen::Quaterniond q = Eigen::Quaterniond(own).normalized();
    out.parent_from_joint[index(bone)] = {q.w(), q.x(), q.y(), q.z()};
  }
}

void joint_sigmas(const UnfoldedPosture& unfolded,
                  const Body& body,
                  const PostureCovariance& covariance,
                  std::array<double, kHumanBoneCount>& out) {
  SparseDerivative derivative;
  for (const HumanBone bone : human_bones()) {
    const HumanBone mover = solved_segment(bone);
    Eigen::Vector3d origin = unfolded.origin(mover);
    if (mover != bone) origin = unfolded.point(mover, eigen(body.proportions[bone]));
    unfolded.derivative(mover, origin, derivative);
    out[index(bone)] = std::hypot(point_sigma_m(covariance.of(derivative)),
                                  body.joint_centre_sigma_m[index(bone)]);
  }
}

}  // namespace marey::reconstruct
