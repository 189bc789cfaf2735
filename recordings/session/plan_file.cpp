// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/plan_file.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/session/calibration_file.h"

namespace marey::recordings {
namespace {

constexpr Limits kPlanSize{16, 20000, "px"};
constexpr Limits kFocal{1.0, 1e5, "px"};
constexpr Limits kFieldOfView{1.0, 170.0, "degrees"};
constexpr Limits kTag{0.005, 1.0, "m"};
constexpr Limits kPlanStature{0.3, 10.0, "m"};
constexpr Limits kStep{0.01, 10.0, "m"};
constexpr double kMaxPlaces = 40000.0;  // Takes some seconds; plan.html has 35 MB then.

/// Reads `count` coordinates within the allowed distance of the world's origin.
std::vector<double> read_near(TomlReader& in,
                              std::string_view key,
                              std::size_t count,
                              const char* next) {
  std::vector<double> v = in.numbers(key, count);
  constexpr double kMaxPlaceDistance_m = 1000.0;
  for (const double x : v) {
    if (std::abs(x) <= kMaxPlaceDistance_m) continue;
    in.fail(key, in_quotes(key) + " is more than a kilometre from the origin", next);
  }
  return v;
}

glm::dvec3 read_place(TomlReader& in, std::string_view key) {
  const auto v = read_near(in, key, 3, "give metres: [x, y, z], y being the height");
  return {v[0], v[1], v[2]};
}

glm::dvec2 read_corner(TomlReader& in, std::string_view key) {
  const auto v = read_near(in, key, 2, "give metres: [x, z] on the floor");
  return {v[0], v[1]};
}

/// Returns the grid points along one side of a volume, both ends included if they are on
/// the grid, as calib::ErrorMapGrid counts them. In double, because the number is not
/// limited yet.
double places_along(double extent_m, double step_m) {
  return std::floor(extent_m / step_m + 1e-9) + 1.0;
}

/// Reads the lens from its angle or its focal length.
void read_lens(TomlReader& in, Intrinsics& k) {
  k.width_px = in.integer("width_px", kPlanSize);
  k.height_px = in.integer("height_px", kPlanSize);
  k.centre_px = {0.5 * (k.width_px - 1), 0.5 * (k.height_px - 1)};
  if (in.has("focal_px") && in.has("field_of_view_deg")) {
    in.fail("focal_px",
            "both \"focal_px\" and \"field_of_view_deg\" are given",
            "remove one: they have the same meaning");
  }
  if (in.has("focal_px")) {
    k.focal_px = glm::dvec2(in.number("focal_px", kFocal));
    return;
  }
  const double across_deg = in.number("field_of_view_deg", kFieldOfView);
  if (!in.ok()) return;
  const double half_rad = 0.5 * across_deg * std::numbers::pi / 180.0;
  k.focal_px = glm::dvec2(0.5 * k.width_px / std::tan(half_rad));
}

/// Reads the pose of a camera whose image's down direction is the world's.
RigidTransform read_aimed_pose(TomlReader& in) {
  const glm::dvec3 place = read_place(in, "place_m");
  const glm::dvec3 target = read_place(in, "looks_at_m");
  const glm::dvec3 ahead = target - place;
  const glm::dvec3 level = glm::cross(glm::dvec3(0.0, -1.0, 0.0), ahead);
  if (!(glm::length(level) > 1e-3 * glm::length(ahead))) {
    in.fail("looks_at_m",
            "the camera looks at itself, or straight up or down",
            "move looks_at_m a little to the side where the picture's top is to be");
    return {};
  }
  const glm::dvec3 z = glm::normalize(ahead);
  const glm::dvec3 x = glm::normalize(level);
  return inverse({glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)), place});
}

Camera read_camera(TomlReader& in, const std::vector<Camera>& before) {
  in.allow({"name",
            "place_m",
            "looks_at_m",
            "width_px",
            "height_px",
            "field_of_view_deg",
            "focal_px"});
  Camera camera;
  camera.name = in.text("name");
  for (const Camera& other : before) {
    if (other.name != camera.name) continue;
    in.fail("name", "another camera has this name", "give each a name of its own");
  }
  camera.camera_from_world = read_aimed_pose(in);
  read_lens(in, camera.intrinsics);
  return camera;
}

TagOnSegment read_tag(TomlReader& in, int id, const std::optional<double>& usual_size_m) {
  in.allow({"segment", "size_m"});
  TagOnSegment tag{
      TagId{id}, HumanBone::kHips, usual_size_m.value_or(kDefaultPlannedTag_m)};
  const std::string segment = in.text("segment");
  if (const auto bone = human_bone(segment)) {
    tag.segment = *bone;
  } else if (in.ok()) {
    in.fail("segment",
            in_quotes(segment) + " is not a segment of a body",
            "use VRM's names: hips, upperChest, head, leftUpperArm...");
  }
  if (in.has("size_m")) tag.size_m = in.number("size_m", kTag);
  return tag;
}

PlannedVolume read_volume(TomlReader in) {
  in.allow({"least_m", "greatest_m", "step_m"});
  PlannedVolume volume;
  volume.min_m = read_corner(in, "least_m");
  volume.max_m = read_corner(in, "greatest_m");
  if (in.has("step_m")) volume.step_m = in.number("step_m", kStep);
  if (!in.ok()) return volume;
  const glm::dvec2 extent = volume.max_m - volume.min_m;
  if (!(extent.x > 0.0 && extent.y > 0.0)) {
    in.fail("greatest_m",
            "\"greatest_m\" must be more than \"least_m\", along x and along z",
            "give two opposite corners of the floor as [x, z]");
  } else if (places_along(extent.x, volume.step_m) *
                 places_along(extent.y, volume.step_m) >
             kMaxPlaces) {
    in.fail(in.has("step_m") ? "step_m" : "greatest_m",
            "the volume has more than 40000 places",
            "make step_m larger");
  }
  return volume;
}

Result<CapturePlan> cameras_of_calibration(std::string_view text,
                                           const std::string& file) {
  auto calibration = parse_calibration(text, file);
  if (!calibration) return calibration.error();
  CapturePlan plan;
  plan.cameras = std::move(calibration->cameras);
  plan.quality = std::move(calibration->quality);
  return plan;
}

}  // namespace

Result<CapturePlan> parse_plan(std::string_view text, const std::string& file) {
  Result<TomlDocument> document = parse_toml(text, file, "plan.md");
  if (!document) return document.error();
  TomlReader root(*document);
  const bool is_plan = root.has("format") || root.has("tag_size_m") ||
                       root.has("volume") ||
                       (root.has("camera") && !root.is_table("camera"));
  if (!is_plan) {
    const TomlKind kind = toml_kind(*document);
    if (kind == TomlKind::kCalibration || kind == TomlKind::kUnknown) {
      return cameras_of_calibration(text, file);
    }
    root.fail("", "no camera in it", "add a [[camera]] for each that you plan");
    return mistake_of(*document, TomlKind::kPlan);
  }
  root.allow({"format", "tag_size_m", "stature_m", "volume", "tag", "camera"});
  if (root.integer("format", {0, 1e6}) != 1) {
    root.fail(
        "format", "the format is not supported", "write format = 1, or update marey");
  }
  CapturePlan plan;
  if (root.has("tag_size_m")) plan.tag_size_m = root.number("tag_size_m", kTag);
  if (root.has("stature_m")) plan.stature_m = root.number("stature_m", kPlanStature);
  if (root.has("volume")) plan.volume = read_volume(root.table("volume"));
  if (root.has("tag")) {
    for (TomlReader& tag : root.tables("tag")) {
      plan.tags.push_back(
          read_tag(tag, static_cast<int>(plan.tags.size()), plan.tag_size_m));
    }
  }
  for (TomlReader& camera : root.tables("camera")) {
    plan.cameras.push_back(read_camera(camera, plan.cameras));
  }
  if (plan.cameras.empty()) {
    root.fail("", "no [[camera]] in it", "add a [[camera]] for each that you plan");
  }
  if (document->mistake) return mistake_of(*document, TomlKind::kPlan);
  return plan;
}

Result<CapturePlan> read_plan(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_plan(*text, path.string());
}

}  // namespace marey::recordings
