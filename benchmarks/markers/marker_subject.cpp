// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/markers/marker_subject.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/pose.h"
#include "reconstruct/labels/name_markers.h"
#include "reconstruct/motion/joint_angles.h"
#include "recordings/markers/marker_file.h"

namespace marey {

void stop(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(1);
}

MarkerTracks read_tracks(const std::filesystem::path& file) {
  auto read = recordings::read_markers(file);
  if (!read) stop(read.error().message());
  return std::move(read->tracks);
}

reconstruct::MarkersFit fit_person(std::span<const MarkerTracks> trials) {
  std::vector<std::string> labels;
  for (const MarkerTracks& trial : trials) {
    for (const std::string& label : trial.labels) {
      if (std::find(labels.begin(), labels.end(), label) == labels.end()) {
        labels.push_back(label);
      }
    }
  }
  const auto names = reconstruct::name_markers(labels);
  std::vector<reconstruct::NamedMarker> named;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    named.push_back({labels[i], names.landmarks[i]});
  }
  auto fit = reconstruct::fit_markers({}, trials, named);
  if (!fit) stop(fit.error().message());
  return *std::move(fit);
}

MarkerPerson read_person(std::span<const std::filesystem::path> files) {
  MarkerPerson person;
  for (const auto& file : files) person.trials.push_back(read_tracks(file));
  person.fit = fit_person(person.trials);
  return person;
}

reconstruct::SolvedMarkers solve(const Body& body, const MarkerTracks& tracks) {
  auto solved = reconstruct::solve_markers(body, tracks);
  if (!solved) stop("no frame shows six markers of the body");
  return *std::move(solved);
}

recordings::MotTable angles_of(const reconstruct::SolvedMarkers& solved,
                               const MarkerTracks& tracks) {
  auto angles = reconstruct::joint_angles(solved.estimate.motion);
  recordings::MotTable table;
  for (std::size_t i = 0; i < reconstruct::kCoordinateCount; ++i) {
    const auto coordinate = static_cast<reconstruct::Coordinate>(i);
    table.columns.push_back(
        {std::string(name(coordinate)), reconstruct::is_angle(coordinate)});
  }
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    table.time_s.push_back(tracks.time_s(f));
  }
  table.values = std::move(angles.values);
  MAREY_ASSERT(table.values.size() == table.rows() * table.columns.size());
  return table;
}

std::vector<std::vector<glm::dvec3>> joints_of(const Motion& motion) {
  std::vector<std::vector<glm::dvec3>> out;
  out.reserve(motion.poses.size());
  for (const Pose& pose : motion.poses) {
    auto& frame = out.emplace_back();
    for (const RigidTransform& joint : world_from_joints(motion.skeleton, pose)) {
      frame.push_back(joint.translation);
    }
  }
  return out;
}

void Distances::add(double distance_m) {
  all_m_.push_back(distance_m);
}

void Distances::add(const Distances& others) {
  all_m_.insert(all_m_.end(), others.all_m_.begin(), others.all_m_.end());
}

double Distances::rms_mm() const {
  double sum = 0.0;
  for (const double d : all_m_) sum += d * d;
  return 1e3 * std::sqrt(sum / static_cast<double>(all_m_.size()));
}

double Distances::mean_mm() const {
  double sum = 0.0;
  for (const double d : all_m_) sum += d;
  return 1e3 * sum / static_cast<double>(all_m_.size());
}

double Distances::quantile_mm(double share) const {
  return 1e3 * quantile(all_m_, share);
}

}  // namespace marey
