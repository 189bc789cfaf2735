// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/simulated_sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace marey::testing {
namespace {

constexpr double kSlope_s = 0.01;  // Step of finite differences.
constexpr double kCommonShare = 0.03;
constexpr double kMissed = 0.02;
constexpr double kBurstsPerSecond = 0.05;
constexpr double kWrongReads = 1e-4;

/// Linear between the points of a table, constant outside.
template <std::size_t N>
double between_points(const std::array<std::array<double, 2>, N>& table, double x) {
  if (x <= table.front()[0]) return table.front()[1];
  for (std::size_t i = 1; i < N; ++i) {
    if (x > table[i][0]) continue;
    const double s = (x - table[i - 1][0]) / (table[i][0] - table[i - 1][0]);
    return table[i - 1][1] + s * (table[i][1] - table[i - 1][1]);
  }
  return table.back()[1];
}

/// Share of unhidden tags that are read, by their shortest edge (measure_plan).
double read_share(double edge_px) {
  constexpr std::array<std::array<double, 2>, 7> kTable{{{10.0, 0.0},
                                                         {13.0, 0.33},
                                                         {15.0, 0.50},
                                                         {17.0, 0.78},
                                                         {19.0, 0.93},
                                                         {21.0, 0.98},
                                                         {30.0, 1.0}}};
  return between_points(kTable, edge_px);
}

/// Noise of a corner's coordinate by the tag's mean side (measure_detection).
double corner_sigma_px(double side_px) {
  constexpr std::array<std::array<double, 2>, 6> kTable{{{12.0, 0.098},
                                                         {16.0, 0.092},
                                                         {20.0, 0.088},
                                                         {26.0, 0.078},
                                                         {40.0, 0.065},
                                                         {80.0, 0.050}}};
  return between_points(kTable, side_px);
}

/// The body and its tags at one time.
struct Instant {
  BoneFrames bones;
  Attitude attitude{};
  std::vector<RigidTransform> world_from_tag;
  std::vector<RigidTransform> a_little_later;  ///< By kSlope_s.
};

RigidTransform still_tag(const SimulatedScene& scene,
                         const BoneFrames& bones,
                         const Attitude& attitude,
                         const GluedTag& tag,
                         const glm::dvec3& acceleration) {
  const RigidTransform& segment = bones[index(tag.tag.segment)];
  return segment * segment_from_tag(tag,
                                    attitude,
                                    scene.reference,
                                    glm::conjugate(segment.rotation) * acceleration);
}

Instant instant_at(const SimulatedScene& scene, const Exercise& exercise, double time_s) {
  Instant now;
  now.attitude = exercise.at(time_s);
  now.bones = place(*scene.body, now.attitude);
  const Attitude before = exercise.at(time_s - kSlope_s);
  const Attitude after = exercise.at(time_s + kSlope_s);
  const BoneFrames bones_before = place(*scene.body, before);
  const BoneFrames bones_after = place(*scene.body, after);
  for (const GluedTag& tag : *scene.tags) {
    const glm::dvec3 p = tag.segment_from_tag.translation;
    const std::size_t bone = index(tag.tag.segment);
    const glm::dvec3 acceleration =
        (bones_before[bone] * p - 2.0 * (now.bones[bone] * p) + bones_after[bone] * p) /
        (kSlope_s * kSlope_s);
    now.world_from_tag.push_back(
        still_tag(scene, now.bones, now.attitude, tag, acceleration));
    now.a_little_later.push_back(still_tag(scene, bones_after, after, tag, acceleration));
  }
  return now;
}

/// A tag in the picture of one camera, without noise.
struct Sight {
  std::array<glm::dvec2, 4> corners_px{};
  double min_edge_px = 0.0;
  double side_px = 0.0;
  double facing_rad = 0.0;  ///< 0 is square on.
};

std::optional<std::array<glm::dvec2, 4>> corners_of(const Camera& camera,
                                                    const RigidTransform& world_from_tag,
                                                    double size_m) {
  std::array<glm::dvec2, 4> corners{};
  for (int i = 0; i < 4; ++i) {
    const auto pixel = project(camera, world_from_tag * corner_in_tag(i, size_m));
    if (!pixel) return std::nullopt;
    corners[static_cast<std::size_t>(i)] = *pixel;
  }
  return corners;
}

std::optional<Sight> look(const Camera& camera,
                          const RigidTransform& world_from_tag,
                          double size_m) {
  const glm::dvec3 into = world_from_tag.rotation * glm::dvec3(0, 0, 1);
  const glm::dvec3 line =
      glm::normalize(world_from_tag.translation - centre_in_world(camera));
  Sight sight;
  sight.facing_rad = std::acos(std::clamp(glm::dot(into, line), -1.0, 1.0));
  if (sight.facing_rad > glm::radians(75.0)) return std::nullopt;
  const auto corners = corners_of(camera, world_from_tag, size_m);
  if (!corners) return std::nullopt;
  sight.corners_px = *corners;
  sight.min_edge_px = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2& p = sight.corners_px[i];
    // The white margin is needed, too.
    const bool inside = p.x > 3.0 && p.y > 3.0 &&
                        p.x < camera.intrinsics.width_px - 4.0 &&
                        p.y < camera.intrinsics.height_px - 4.0;
    if (!inside) return std::nullopt;
    const double edge_px = glm::distance(p, sight.corners_px[(i + 1) % 4]);
    sight.min_edge_px = std::min(sight.min_edge_px, edge_px);
    sight.side_px += 0.25 * edge_px;
  }
  return sight;
}

/// One camera's detector. Keeps each tag's corner bias and dropout over the frames.
class Detector {
 public:
  Detector(const SimulatedScene& scene,
           const Camera& camera,
           const SimulatedFilm& film,
           Dice& dice)
      : scene_(scene), camera_(camera), film_(film), dice_(dice) {
    for (std::size_t i = 0; i < scene.tags->size(); ++i) {
      std::array<glm::dvec2, 4> bias{};
      for (glm::dvec2& b : bias) b = {dice.noise(1.0), dice.noise(1.0)};
      bias_.push_back(bias);
      blind_until_s_.push_back(-1.0);
    }
  }

  std::vector<TagDetection> detect(const Instant& now, double time_s) {
    std::vector<TagDetection> found;
    for (std::size_t i = 0; i < scene_.tags->size(); ++i) {
      if (auto tag = read(now, i, time_s)) found.push_back(*tag);
      if (!found.empty() && dice_.between(0, 1) < kWrongReads) add_wrong(found);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return a.id < b.id;
    });
    return found;
  }

 private:
  std::optional<TagDetection> read(const Instant& now, std::size_t i, double time_s) {
    const GluedTag& tag = (*scene_.tags)[i];
    if (dice_.between(0, 1) < kBurstsPerSecond / film_.hz) {
      blind_until_s_[i] = time_s + dice_.between(0.2, 1.0);
    }
    const double chance = dice_.between(0, 1);
    const auto sight = look(camera_, now.world_from_tag[i], tag.tag.size_m);
    if (!sight || time_s < blind_until_s_[i]) return std::nullopt;
    const double blur_px = blur(now, i, tag.tag.size_m);
    // tag36h11 is eight modules wide; a blur of more than one hides its bits.
    const double modules = blur_px / (sight->min_edge_px / 8.0);
    const double read = (1.0 - kMissed) * read_share(sight->min_edge_px) /
                        (1.0 + std::exp((modules - 1.2) / 0.15)) /
                        (1.0 + std::exp((glm::degrees(sight->facing_rad) - 65.0) / 1.5));
    if (chance > read || hidden(now, i)) return std::nullopt;
    TagDetection out;
    out.id = tag.tag.id;
    out.decision_margin = 80.0;
    const double sigma_px = std::hypot(corner_sigma_px(sight->side_px), 0.05 * blur_px);
    out.sigma_px = sigma_px * film_.sigma_factor * std::exp(dice_.noise(0.15));
    for (std::size_t c = 0; c < 4; ++c) {
      const glm::dvec2 own(dice_.noise(1.0), dice_.noise(1.0));
      out.corners_px[c] =
          sight->corners_px[c] + sigma_px * (std::sqrt(1.0 - kCommonShare) * own +
                                             std::sqrt(kCommonShare) * bias_[i][c]);
    }
    return out;
  }

  double blur(const Instant& now, std::size_t i, double size_m) const {
    const auto from = corners_of(camera_, now.world_from_tag[i], size_m);
    const auto to = corners_of(camera_, now.a_little_later[i], size_m);
    if (!from || !to) return 0.0;
    double max_px = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      max_px = std::max(max_px, glm::distance((*from)[c], (*to)[c]));
    }
    return max_px * film_.exposure_s / kSlope_s;
  }

  bool hidden(const Instant& now, std::size_t i) const {
    constexpr double kThinner_m = 0.012;
    const GluedTag& tag = (*scene_.tags)[i];
    const glm::dvec3 eye = centre_in_world(camera_);
    const auto is_hidden_at = [&](const glm::dvec3& p_in_tag) {
      return is_hidden(*scene_.soft_tissue,
                       now.bones,
                       now.world_from_tag[i] * p_in_tag,
                       eye,
                       tag.tag.segment,
                       kThinner_m);
    };
    for (int c = 0; c < 4; ++c) {
      if (is_hidden_at(corner_in_tag(c, tag.tag.size_m))) return true;
    }
    return is_hidden_at(glm::dvec3(0.0));
  }

  void add_wrong(std::vector<TagDetection>& found) {
    const auto any = static_cast<std::size_t>(
        dice_.between(0.0, static_cast<double>(scene_.tags->size()) - 1e-9));
    const TagId id = (*scene_.tags)[any].tag.id;
    const bool is_seen = std::any_of(
        found.begin(), found.end(), [&](const TagDetection& t) { return t.id == id; });
    if (is_seen) return;
    TagDetection wrong = found.back();
    wrong.id = id;
    const glm::dvec2 to(dice_.between(40.0, camera_.intrinsics.width_px - 40.0),
                        dice_.between(40.0, camera_.intrinsics.height_px - 40.0));
    const glm::dvec2 off = to - wrong.corners_px[0];
    for (glm::dvec2& corner : wrong.corners_px) corner += off;
    wrong.hamming = 1;
    found.push_back(wrong);
  }

  const SimulatedScene& scene_;
  const Camera& camera_;
  const SimulatedFilm& film_;
  Dice& dice_;
  std::vector<std::array<glm::dvec2, 4>> bias_;
  std::vector<double> blind_until_s_;
};

}  // namespace

std::vector<CameraDetections> film(const SimulatedScene& scene,
                                   const Exercise& exercise,
                                   const std::vector<Camera>& cameras,
                                   const SimulatedFilm& film,
                                   Dice& dice) {
  std::vector<CameraDetections> out;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    CameraDetections camera;
    camera.source = film.name + "/" + cameras[c].name + ".mp4";
    camera.camera = CameraId{static_cast<int>(c)};
    camera.width_px = cameras[c].intrinsics.width_px;
    camera.height_px = cameras[c].intrinsics.height_px;
    camera.rate.hz = film.hz;
    Detector detector(scene, cameras[c], film, dice);
    for (int f = 0; f < film.frames; ++f) {
      const double time_s = f / film.hz + film.offsets_s[c];
      camera.frames.push_back(
          {f, detector.detect(instant_at(scene, exercise, time_s), time_s), {}});
    }
    out.push_back(std::move(camera));
  }
  return out;
}

}  // namespace marey::testing
