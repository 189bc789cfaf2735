// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/plan/body_information.h"

#include <algorithm>

#include "calib/model/project_point.h"
#include "calib/plan/tag_visibility.h"
#include "core/base/cross_matrix.h"

namespace marey::calib {
namespace {

constexpr int kPerCamera = static_cast<int>(RigCovariance::kPerCamera);
constexpr int kLocal = kLengthColumns + 6 + kPerCamera + kBaseColumns;

/// Derivatives, in sigmas, of the eight coordinates of a tag's corners.
struct ViewRows {
  Eigen::Matrix<double, 8, kPostureColumns> by_posture;
  Eigen::Matrix<double, 8, kLocal> by_shared;  ///< Lengths, tag, camera, base.
};

std::optional<ViewRows> rows_of(const Camera& camera,
                                const PlacedTag& tag,
                                const BodyPlace& place,
                                const PostureJacobian& jacobian,
                                double sigma_px) {
  const std::size_t bone = index(tag.tag.segment);
  const RigidTransform& world_from_bone = place[bone];
  const RigidTransform world_from_tag = world_from_bone * tag.segment_from_tag;
  const TagCorners corners = corners_in_world(world_from_tag, tag.tag.size_m);
  const Eigen::Matrix3d turn = to_eigen(world_from_bone.rotation).toRotationMatrix();
  ViewRows rows;
  for (int c = 0; c < 4; ++c) {
    const glm::dvec3& corner = corners[static_cast<std::size_t>(c)];
    const auto sight = project_point(camera, corner);
    if (!sight) return std::nullopt;
    const Eigen::Matrix<double, 2, 3> by_point = sight->by_point / sigma_px;
    const Eigen::Vector3d from_bone = to_eigen(corner - world_from_bone.translation);
    const Eigen::Vector3d from_centre = to_eigen(corner - world_from_tag.translation);
    rows.by_posture.middleRows<2>(2 * c) =
        by_point * (jacobian.origin[bone] -
                    cross_matrix<Eigen::Matrix3d>(from_bone) * jacobian.spin[bone]);
    rows.by_shared.middleRows<2>(2 * c) << by_point * jacobian.origin_by_length[bone],
        -by_point * cross_matrix<Eigen::Matrix3d>(from_centre) * turn, by_point * turn,
        sight->by_camera / sigma_px, by_point * jacobian.origin_by_base[bone];
  }
  return rows;
}

}  // namespace

std::vector<BodyView> views_of(std::span<const Camera> cameras,
                               const PlannedBody& body,
                               const BodyPlace& place,
                               const PlanOptions& options) {
  const std::vector<SoftTissueCapsule> soft_tissue = soft_tissue_of(body, place);
  std::vector<BodyView> views;
  for (std::size_t t = 0; t < body.tags.size(); ++t) {
    const PlacedTag& tag = body.tags[t];
    const RigidTransform world_from_tag =
        place[index(tag.tag.segment)] * tag.segment_from_tag;
    const TagCorners corners = corners_in_world(world_from_tag, tag.tag.size_m);
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const auto side_px = visible_side_px(cameras[c], world_from_tag, corners, options);
      if (!side_px) continue;
      const glm::dvec3 eye = centre_in_world(cameras[c]);
      const bool hidden =
          std::any_of(corners.begin(), corners.end(), [&](const glm::dvec3& corner) {
            return is_hidden(corner, eye, soft_tissue);
          });
      if (!hidden) views.push_back({t, c, *side_px});
    }
  }
  return views;
}

FrameInformation information_of(std::span<const Camera> cameras,
                                const PlannedBody& body,
                                const BodyPlace& place,
                                const PostureJacobian& jacobian,
                                std::span<const BodyView> views,
                                const CornerSigma& corner_sigma,
                                const SharedColumns& columns,
                                Eigen::MatrixXd* shared) {
  FrameInformation out;
  out.coupling = Eigen::MatrixXd::Zero(kPostureColumns, columns.count());
  for (const BodyView& view : views) {
    const auto rows = rows_of(cameras[view.camera],
                              body.tags[view.tag],
                              place,
                              jacobian,
                              corner_sigma(view.side_px));
    if (!rows) continue;
    out.posture.noalias() += rows->by_posture.transpose() * rows->by_posture;
    // Targets of the local columns: first, local first, count.
    const std::array<std::array<int, 3>, 4> parts{
        {{0, 0, kLengthColumns},
         {columns.tag(view.tag), kLengthColumns, 6},
         {columns.camera(view.camera), kLengthColumns + 6, kPerCamera},
         {columns.base(), kLengthColumns + 6 + kPerCamera, kBaseColumns}}};
    for (const auto& [to, from, count] : parts) {
      out.coupling.middleCols(to, count).noalias() +=
          rows->by_posture.transpose() * rows->by_shared.middleCols(from, count);
      if (!shared) continue;
      for (const auto& [to_row, from_row, rows_count] : parts) {
        shared->block(to_row, to, rows_count, count).noalias() +=
            rows->by_shared.middleCols(from_row, rows_count).transpose() *
            rows->by_shared.middleCols(from, count);
      }
    }
  }
  return out;
}

void add_posture_prior(const PosturePriorRows& prior, FrameInformation& information) {
  constexpr double kWeakPrior = 1e-4;  // A hundred metres: keeps pivots positive.
  information.posture.noalias() += prior.transpose() * prior;
  information.posture.diagonal().array() += kWeakPrior;
}

}  // namespace marey::calib
