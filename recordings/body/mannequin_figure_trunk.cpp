// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "recordings/body/mannequin_figure.h"

namespace marey::recordings {
namespace {

using B = HumanBone;

constexpr std::size_t kTrunkSegments = 32;
constexpr std::size_t kHeadSegments = 24;
constexpr std::size_t kNeckSegments = 20;

constexpr std::array<B, 5> kTrunk{
    B::kHips, B::kSpine, B::kChest, B::kUpperChest, B::kNeck};

/// Returns the weights at `at` along the trunk (0 hips, 1 spine, ... 4 neck): the bone
/// whose section contains `at`, and its neighbour.
std::array<double, 5> trunk_weights(double at) {
  std::array<double, 5> weights{};
  const double place = std::clamp(at - 0.5, 0.0, 3.0);
  const double below = std::min(std::floor(place), 2.0);
  const double share = ease(0.0, 1.0, place - below);
  weights[static_cast<std::size_t>(below)] = 1.0 - share;
  weights[static_cast<std::size_t>(below) + 1] = share;
  return weights;
}

/// Shares the skin next to the shoulders and above the thighs with those bones.
SkinWeights trunk_skin(double at, double across, double half_m) {
  const std::array<double, 5> w = trunk_weights(at);
  const B shoulder = across > 0.0 ? B::kLeftShoulder : B::kRightShoulder;
  const B thigh = across > 0.0 ? B::kLeftUpperLeg : B::kRightUpperLeg;
  const double aside = std::abs(across) / half_m;
  if (at < 0.0) {
    const double share = 0.4 * ease(-0.1, -0.9, at) * ease(0.1, 0.7, aside);
    return carried_by({{B::kHips, 1.0 - share}, {thigh, share}});
  }
  const double share = 0.75 * ease(2.6, 3.4, at) * ease(0.25, 0.9, aside);
  const double rest = 1.0 - share;
  return carried_by({{B::kHips, w[0] * rest},
                     {B::kSpine, w[1] * rest},
                     {B::kChest, w[2] * rest},
                     {B::kUpperChest, w[3] * rest},
                     {shoulder, share}});
}

/// Returns half the distance between two joints, as a fraction of the size. Above 0.
double half_breadth(const Figure& figure, B left, B right) {
  const double breadth_m = glm::distance(figure.at(left), figure.at(right));
  return std::max(0.5 * breadth_m / figure.size_m, 0.02);
}

std::vector<Section> trunk_sections(double hips, double shoulders) {
  const double waist = 0.36 * (hips + shoulders);
  return {{-1.05, 0.30 * hips, 0.020, 0.000},
          {-0.9, 0.52 * hips, 0.036, 0.000},
          {-0.55, 0.82 * hips, 0.053, -0.002},
          {-0.15, 0.99 * hips, 0.062, -0.004},
          {0.25, 0.99 * hips, 0.061, -0.004},
          {0.7, 0.90 * hips, 0.055, -0.001},
          {1.2, 1.00 * waist, 0.049, 0.002},
          {1.65, 1.05 * waist, 0.050, 0.004},
          {2.2, 0.80 * shoulders, 0.057, 0.006},
          {2.8, 0.92 * shoulders, 0.064, 0.007},
          {3.2, 0.98 * shoulders, 0.062, 0.003},
          {3.5, 0.94 * shoulders, 0.053, -0.001},
          {3.75, 0.70 * shoulders, 0.042, -0.003},
          {3.95, 0.43 * shoulders, 0.034, -0.002},
          {4.1, 0.18 * shoulders, 0.020, 0.000}};
}

/// Returns the trunk's centre at `at`: along the spine, below the hips towards the
/// crotch.
glm::dvec3 trunk_middle(const Figure& figure, double at) {
  if (at < 0.0) {
    const glm::dvec3 crotch =
        0.5 * (figure.at(B::kLeftUpperLeg) + figure.at(B::kRightUpperLeg)) -
        glm::dvec3(0, 0.052 * figure.size_m, 0);
    return glm::mix(figure.at(B::kHips), crotch, -at);
  }
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), 3);
  return glm::mix(
      figure.at(kTrunk[i]), figure.at(kTrunk[i + 1]), at - static_cast<double>(i));
}

/// Returns the unit vector from right to left: along the hips below, the shoulders above.
glm::dvec3 trunk_left(const Figure& figure, double at) {
  const glm::dvec3 hips =
      direction(figure.at(B::kLeftUpperLeg) - figure.at(B::kRightUpperLeg), {1, 0, 0});
  const glm::dvec3 shoulders =
      direction(figure.at(B::kLeftUpperArm) - figure.at(B::kRightUpperArm), {1, 0, 0});
  return direction(glm::mix(hips, shoulders, ease(0.5, 3.0, at)), {1, 0, 0});
}

Ring trunk_ring(const Figure& figure, const Section& section) {
  const glm::dvec3 left = trunk_left(figure, section.at);
  Ring ring;
  ring.front = unit_across({0, 0, 1}, left);
  ring.along = glm::cross(ring.front, left);
  ring.centre =
      trunk_middle(figure, section.at) + section.shift * figure.thickness_m * ring.front;
  ring.half_width = section.half_width * figure.thickness_m;
  ring.half_depth = section.half_depth * figure.thickness_m;
  ring.exponent = 2.5;
  ring.part = section.at > 0.9 && section.at < 1.5 ? kJoint : kSkin;
  return ring;
}

/// Adds a marker on the breastbone.
void add_breast_mark(Figure& figure, std::span<const Section> sections) {
  Ring ring = trunk_ring(figure, section_at(sections, 2.55));
  ring.centre += ring.half_depth * ring.front;
  ring.half_width = 0.013 * figure.thickness_m;
  ring.half_depth = 0.005 * figure.thickness_m;
  ring.exponent = 2.0;
  ring.part = kMark;
  ring.skin = trunk_skin(2.55, 0.0, 1.0);
  figure.builder.add_ellipsoid(ring, ring.half_width, 12);
}

}  // namespace

void add_trunk(Figure& figure) {
  // Width of the soft tissue outside of the hip joints.
  constexpr double kBeside = 0.040;
  const double hips = half_breadth(figure, B::kLeftUpperLeg, B::kRightUpperLeg) + kBeside;
  const double shoulders = half_breadth(figure, B::kLeftUpperArm, B::kRightUpperArm);
  const std::vector<Section> sections = trunk_sections(hips, shoulders);
  const std::vector<double> places = places_along(sections, 44);
  std::vector<Ring> rings;
  rings.reserve(places.size());
  for (const double at : places) {
    rings.push_back(trunk_ring(figure, section_at(sections, at)));
  }
  const auto [first, last] = figure.builder.add_turned(rings, kTrunkSegments);
  SkinnedMesh& mesh = figure.builder.mesh();
  for (std::size_t v = first; v < last; ++v) {
    // One pole, then rings of kTrunkSegments, then the other pole.
    const std::size_t ring = (v - first + kTrunkSegments - 1) / kTrunkSegments;
    const double across = glm::dot(mesh.p_in_world[v] - rings[ring].centre,
                                   trunk_left(figure, places[ring]));
    const double half_m = (places[ring] < 0.0 ? hips : shoulders) * figure.thickness_m;
    mesh.skin[v] = trunk_skin(places[ring], across, half_m);
  }
  add_breast_mark(figure, sections);
}

void add_neck(Figure& figure) {
  static constexpr std::array<Section, 5> kSections{{{-0.35, 0.020, 0.020, 0},
                                                     {0.0, 0.0315, 0.0330, 0},
                                                     {0.5, 0.0275, 0.0300, 0},
                                                     {1.0, 0.0270, 0.0300, 0},
                                                     {1.5, 0.018, 0.020, 0}}};
  const glm::dvec3 neck = figure.at(B::kHead) - figure.at(B::kNeck);
  Ring ring;
  ring.along = direction(neck, {0, 1, 0});
  ring.front = unit_across({0, 0, 1}, ring.along);
  ring.part = kJoint;
  std::vector<Ring> rings;
  for (const double at : places_along(kSections, 12)) {
    const Section section = section_at(kSections, at);
    ring.centre = figure.at(B::kNeck) + at * neck;
    ring.half_width = section.half_width * figure.thickness_m;
    ring.half_depth = section.half_depth * figure.thickness_m;
    const double head = ease(0.3, 1.2, at);
    const double chest = ease(0.5, -0.3, at);
    ring.skin = carried_by({{B::kUpperChest, chest},
                            {B::kNeck, std::max(0.0, 1.0 - chest - head)},
                            {B::kHead, head}});
    rings.push_back(ring);
  }
  (void)figure.builder.add_turned(rings, kNeckSegments);
}

namespace {

/// Adds nose and eyes, as fractions of the head's height from its joint to its top.
void add_face(Figure& figure, const Ring& frame, double height_m) {
  const glm::dvec3 side = glm::cross(frame.along, frame.front);
  const auto add = [&](glm::dvec3 place, glm::dvec3 half, FigurePart part) {
    Ring ring = frame;
    ring.centre =
        figure.at(B::kHead) +
        height_m * (place.x * side + place.y * frame.along + place.z * frame.front);
    ring.half_width = half.x * height_m;
    ring.half_depth = half.z * height_m;
    ring.exponent = 2.0;
    ring.part = part;
    figure.builder.add_ellipsoid(ring, half.y * height_m, 12);
  };
  add({0.0, 0.24, 0.475}, {0.052, 0.12, 0.10}, kMark);
  add({0.165, 0.42, 0.445}, {0.062, 0.045, 0.035}, kJoint);
  add({-0.165, 0.42, 0.445}, {0.062, 0.045, 0.035}, kJoint);
}

}  // namespace

void add_head(Figure& figure) {
  // As fractions of the height from head joint to top; at: 0 head joint, 1 top.
  static constexpr std::array<Section, 9> kSections{{{-0.16, 0.08, 0.07, 0.20},
                                                     {-0.11, 0.21, 0.20, 0.18},
                                                     {0.0, 0.305, 0.32, 0.125},
                                                     {0.2, 0.365, 0.425, 0.06},
                                                     {0.45, 0.400, 0.47, 0.02},
                                                     {0.66, 0.405, 0.48, -0.01},
                                                     {0.85, 0.340, 0.40, -0.02},
                                                     {0.965, 0.190, 0.22, -0.02},
                                                     {1.0, 0.05, 0.06, -0.02}}};
  const glm::dvec3 top = figure.proportions.head_top_in_head;
  const double height_m = glm::length(top);
  Ring ring;
  ring.along = direction(top, {0, 1, 0});
  ring.front = unit_across({0, 0, 1}, ring.along);
  ring.skin = carried_by({{B::kHead, 1.0}});
  std::vector<Ring> rings;
  for (const double at : places_along(kSections, 22)) {
    const Section section = section_at(kSections, at);
    ring.centre = figure.at(B::kHead) + at * top + section.shift * height_m * ring.front;
    ring.half_width = section.half_width * height_m;
    ring.half_depth = section.half_depth * height_m;
    ring.exponent = 2.25;
    rings.push_back(ring);
  }
  (void)figure.builder.add_turned(rings, kHeadSegments);
  add_face(figure, ring, height_m);
}

}  // namespace marey::recordings
