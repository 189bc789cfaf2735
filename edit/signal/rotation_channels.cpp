// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/signal/rotation_channels.h"

#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/transform.h"

namespace marey::edit {
namespace {

/// Beyond this angle the logarithm about the filtered rotations may be ambiguous.
constexpr double kMaxSecondRun_rad = 0.5 * std::numbers::pi;

glm::dvec3 rotation_step(const glm::dquat& from, const glm::dquat& to) {
  return rotation_vector(glm::conjugate(from) * to);
}

/// Lee & Shin's filter with weights (1, 4, 6, 4, 1) / 16: the displacement of sample i is
/// (w_(i+1) + 5 w_i - 5 w_(i-1) - w_(i-2)) / 16, w_i = log(q_i^-1 q_(i+1)). Outside the
/// sequence, w continues with the value at the end.
std::vector<glm::dquat> binomial_reference(std::span<const glm::dquat> rotations) {
  std::vector<glm::dquat> reference(rotations.begin(), rotations.end());
  if (rotations.size() < 2) return reference;
  std::vector<glm::dvec3> steps;
  for (std::size_t i = 0; i + 1 < rotations.size(); ++i) {
    steps.push_back(rotation_step(rotations[i], rotations[i + 1]));
  }
  const auto last = static_cast<std::ptrdiff_t>(steps.size()) - 1;
  const auto step = [&](std::ptrdiff_t i) {
    return steps[static_cast<std::size_t>(i < 0 ? 0 : i > last ? last : i)];
  };
  for (std::size_t at = 0; at < rotations.size(); ++at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const glm::dvec3 displacement =
        (step(i + 1) + 5.0 * step(i) - 5.0 * step(i - 1) - step(i - 2)) / 16.0;
    reference[at] = glm::normalize(rotations[at] * rotation_from_vector(displacement));
  }
  return reference;
}

}  // namespace

RotationChannels::RotationChannels(std::span<const glm::dquat> rotations)
    : reference_(binomial_reference(rotations)) {
  develop(rotations);
}

RotationChannels::RotationChannels(std::span<const glm::dquat> rotations,
                                   std::span<const glm::dquat> reference)
    : reference_(reference.begin(), reference.end()) {
  MAREY_ASSERT(reference.size() == rotations.size());
  develop(rotations);
}

void RotationChannels::develop(std::span<const glm::dquat> rotations) {
  developed_.reserve(rotations.size());
  for (std::vector<double>& channel : channels_) channel.reserve(rotations.size());
  glm::dvec3 x{0.0};
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    if (i > 0) x += rotation_step(reference_[i - 1], reference_[i]);
    developed_.push_back(x);
    const glm::dvec3 y = x + rotation_step(reference_[i], rotations[i]);
    channels_[0].push_back(y.x);
    channels_[1].push_back(y.y);
    channels_[2].push_back(y.z);
  }
}

std::vector<glm::dquat> RotationChannels::rotations_of(
    std::span<const std::vector<double>> filtered) const {
  MAREY_ASSERT(filtered.size() == 3);
  for (const auto& channel : filtered) MAREY_ASSERT(channel.size() == reference_.size());
  std::vector<glm::dquat> rotations;
  rotations.reserve(reference_.size());
  for (std::size_t i = 0; i < reference_.size(); ++i) {
    const glm::dvec3 y{filtered[0][i], filtered[1][i], filtered[2][i]};
    glm::dquat rotation =
        glm::normalize(reference_[i] * rotation_from_vector(y - developed_[i]));
    if (i > 0 && glm::dot(rotations.back(), rotation) < 0.0) rotation = -rotation;
    rotations.push_back(rotation);
  }
  return rotations;
}

std::vector<glm::dquat> filter_rotations(std::span<const glm::dquat> rotations,
                                         const VectorFilter& filter) {
  const auto filtered_about = [&](const RotationChannels& channels) {
    std::array<std::vector<double>, 3> y = channels.channels();
    filter(y);
    return channels.rotations_of(y);
  };
  std::vector<glm::dquat> first = filtered_about(RotationChannels(rotations));
  for (std::size_t i = 0; i < first.size(); ++i) {
    const glm::dvec3 removed = rotation_step(first[i], rotations[i]);
    if (glm::length(removed) > kMaxSecondRun_rad) return first;
  }
  return filtered_about(RotationChannels(rotations, first));
}

}  // namespace marey::edit
