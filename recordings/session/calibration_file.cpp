// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/calibration_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/toml_kind.h"
#include "recordings/base/toml_reader.h"
#include "recordings/base/toml_writer.h"
#include "recordings/session/calibration_import.h"
#include "recordings/session/camera_numbers.h"

namespace marey::recordings {
namespace {

constexpr Limits kAny{-1e12, 1e12};
constexpr Limits kNotNegative{0.0, 1e12};
constexpr Limits kCount{0, 2e9};

std::array<double, 16> matrix_of(const RigidTransform& b_from_a) {
  const glm::dmat3 r = glm::mat3_cast(b_from_a.rotation);  // r[column][row]
  const glm::dvec3& t = b_from_a.translation;
  return {r[0][0],
          r[1][0],
          r[2][0],
          t.x,  //
          r[0][1],
          r[1][1],
          r[2][1],
          t.y,  //
          r[0][2],
          r[1][2],
          r[2][2],
          t.z,  //
          0.0,
          0.0,
          0.0,
          1.0};
}

void write_pose(TomlWriter& out, const RigidTransform& camera_from_world) {
  const glm::dquat& q = camera_from_world.rotation;
  const glm::dvec3& t = camera_from_world.translation;
  const glm::dvec3 vector_rad = rotation_vector(q);
  out.numbers("rotation", {vector_rad.x, vector_rad.y, vector_rad.z});
  out.numbers("translation", {t.x, t.y, t.z});
  // The exact pose, because a rotation vector rounds; then its inverse, for readers.
  out.numbers("rotation_wxyz", {q.w, q.x, q.y, q.z});
  out.matrix("world_from_camera", matrix_of(inverse(camera_from_world)), 4);
}

void write_camera(TomlWriter& out,
                  const Camera& camera,
                  const CameraQuality& quality,
                  const CameraClock& clock) {
  const Intrinsics& k = camera.intrinsics;
  out.table({camera.name});
  out.text("name", camera.name);
  out.integers("size", {k.width_px, k.height_px});
  const std::array<double, 9> matrix{
      k.focal_px.x, 0.0, k.centre_px.x, 0.0, k.focal_px.y, k.centre_px.y, 0.0, 0.0, 1.0};
  out.matrix("matrix", matrix, 3);
  out.numbers("distortions", std::span(k.distortion).first(distortion_terms(k.lens)));
  out.boolean("fisheye", k.lens == LensModel::kFisheye);
  write_pose(out, camera.camera_from_world);
  out.number("tag_shrinkage_px", camera.tag_shrinkage.offset_px);
  out.number("tag_shrinkage_slope", camera.tag_shrinkage.slope);
  out.number("time_offset_s", clock.offset_s);
  out.number("drift_ppm", clock.drift_ppm);
  out.number("line_delay_s", clock.line_delay_s);
  out.number("rms_px", quality.rms_px);
  out.number("p95_px", quality.p95_px);
  out.number("centre_sigma_m", quality.centre_sigma_m);
  out.number("focal_sigma_px", quality.focal_sigma_px);
  out.integer("views", quality.views);
  out.integer("corners", quality.corners);
  out.number("coverage", quality.coverage);
}

void read_size(TomlReader& in, Intrinsics& k) {
  const std::vector<double> size = in.numbers("size", 2);
  constexpr double kMaxSide_px = 1e5;
  for (const double side : size) {
    // Pose2Sim writes integers as 1920.0.
    if (side >= 1 && side <= kMaxSide_px && side == std::floor(side)) continue;
    in.fail(
        "size", "\"size\" must be two whole numbers of pixels", "write [width, height]");
    return;
  }
  k.width_px = static_cast<int>(size[0]);
  k.height_px = static_cast<int>(size[1]);
}

void read_intrinsics(TomlReader& in, Intrinsics& k) {
  read_size(in, k);
  const std::vector<double> m = in.matrix("matrix", 3, 3);
  if (!set_pinhole(std::span<const double, 9>(m.data(), 9), k)) {
    in.fail("matrix",
            "\"matrix\" must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]",
            "calibrate without skew");
  }
  const bool is_fisheye = in.has("fisheye") && in.boolean("fisheye");
  const std::size_t given = in.count("distortions");
  if (is_fisheye) {
    k.lens = LensModel::kFisheye;
  } else if (given == distortion_terms(LensModel::kRational)) {
    k.lens = LensModel::kRational;
  }
  // OpenCV's shortest form omits k3.
  const std::size_t terms = given == 4 ? 4 : distortion_terms(k.lens);
  const std::vector<double> distortion = in.numbers("distortions", terms);
  std::copy(distortion.begin(), distortion.end(), k.distortion.begin());
}

/// Returns rotation_wxyz if it agrees with `rotation`.
glm::dquat read_quaternion(TomlReader& in, const glm::dquat& rotation) {
  const std::vector<double> wxyz = in.numbers("rotation_wxyz", 4);
  const glm::dquat q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  // Far above rounding, far below a relevant difference.
  constexpr double kTolerance = 1e-9;
  const double difference =
      std::min(glm::length(q - rotation), glm::length(q + rotation));
  if (difference > kTolerance) {
    in.fail("rotation_wxyz",
            "\"rotation\" and \"rotation_wxyz\" are different rotations",
            "remove rotation_wxyz, and world_from_camera, if rotation is right");
  }
  return q;
}

void check_matrix(TomlReader& in, const RigidTransform& camera_from_world) {
  const std::vector<double> given = in.matrix("world_from_camera", 4, 4);
  const std::array<double, 16> expected = matrix_of(inverse(camera_from_world));
  constexpr double kTolerance = 1e-6;  // May have been rounded by hand.
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (std::abs(given[i] - expected[i]) <= kTolerance) continue;
    in.fail("world_from_camera",
            "\"world_from_camera\" is not the inverse of rotation and translation",
            "remove world_from_camera if rotation and translation are right");
  }
}

glm::dquat read_rotation(TomlReader& in) {
  if (!in.is_matrix("rotation")) {
    const std::vector<double> vector_rad = in.numbers("rotation", 3);
    return rotation_from_vector({vector_rad[0], vector_rad[1], vector_rad[2]});
  }
  // Caliscope's form.
  const std::vector<double> rows = in.matrix("rotation", 3, 3);
  const auto rotation = rotation_of_rows(std::span<const double, 9>(rows.data(), 9));
  if (!rotation) {
    in.fail("rotation", "\"rotation\" is not a rotation", "export it again");
  }
  return rotation.value_or(glm::dquat(1.0, 0.0, 0.0, 0.0));
}

RigidTransform read_pose(TomlReader& in) {
  const std::vector<double> t = in.numbers("translation", 3);
  RigidTransform camera_from_world;
  camera_from_world.rotation = read_rotation(in);
  camera_from_world.translation = {t[0], t[1], t[2]};
  // marey's own files are in metres, but may have been edited.
  constexpr double kMaxOwnDistance_m = 1000.0;
  const bool is_ours = in.has("rotation_wxyz");
  const double distance_m = glm::length(camera_from_world.translation);
  if (is_ours) {
    camera_from_world.rotation = read_quaternion(in, camera_from_world.rotation);
  }
  if (is_ours && distance_m > kMaxOwnDistance_m) {
    in.fail("translation",
            "the camera stands more than a kilometre from the world's origin",
            "correct it, or run marey calibrate again");
  } else if (!is_ours && distance_m > kMaxCameraDistance_m) {
    in.fail("translation",
            "the camera stands more than 100 m from the world's origin",
            "give positions in metres: divide them by 1000 if they are millimetres");
  }
  if (in.has("world_from_camera")) check_matrix(in, camera_from_world);
  return camera_from_world;
}

void read_if_there(TomlReader& in,
                   std::string_view key,
                   const Limits& limits,
                   double& value) {
  if (in.has(key)) value = in.number(key, limits);
}

void read_if_there(TomlReader& in,
                   std::string_view key,
                   const Limits& limits,
                   int& value) {
  if (in.has(key)) value = in.integer(key, limits);
}

CameraClock read_clock(TomlReader& in) {
  CameraClock clock;
  read_if_there(in, "time_offset_s", kAny, clock.offset_s);
  read_if_there(in, "drift_ppm", kAny, clock.drift_ppm);
  read_if_there(in, "line_delay_s", kAny, clock.line_delay_s);
  return clock;
}

CameraQuality read_quality(TomlReader& in) {
  CameraQuality quality;
  read_if_there(in, "rms_px", kNotNegative, quality.rms_px);
  read_if_there(in, "p95_px", kNotNegative, quality.p95_px);
  read_if_there(in, "centre_sigma_m", kNotNegative, quality.centre_sigma_m);
  read_if_there(in, "focal_sigma_px", kNotNegative, quality.focal_sigma_px);
  read_if_there(in, "views", kCount, quality.views);
  read_if_there(in, "corners", kCount, quality.corners);
  read_if_there(in, "coverage", {0.0, 1.0}, quality.coverage);
  return quality;
}

void read_camera(TomlReader& in,
                 const std::string& key,
                 std::set<std::string>& names,
                 Calibration& out) {
  Camera camera;
  // Caliscope's videos and timestamps are named cam_0, cam_1...
  const bool is_number = key.find_first_not_of("0123456789") == std::string::npos;
  camera.name = in.has("name") ? in.text("name") : is_number ? "cam_" + key : key;
  read_intrinsics(in, camera.intrinsics);
  camera.camera_from_world = read_pose(in);
  read_if_there(in, "tag_shrinkage_px", kAny, camera.tag_shrinkage.offset_px);
  // At 1 a tag would need an infinite size in the image.
  read_if_there(in, "tag_shrinkage_slope", {-0.5, 0.5}, camera.tag_shrinkage.slope);
  if (!names.insert(camera.name).second) {
    in.fail("name", "two cameras have the name " + in_quotes(camera.name), "rename one");
  }
  out.cameras.push_back(std::move(camera));
  out.quality.push_back(read_quality(in));
  out.clocks.push_back(read_clock(in));
}

bool is_camera(const std::string& key) {
  // Tables that Pose2Sim and Caliscope write in addition to the cameras.
  constexpr std::array<std::string_view, 4> kOthers{
      "metadata", "capture_volume", "charuco", "checkerboard"};
  return std::find(kOthers.begin(), kOthers.end(), key) == kOthers.end();
}

}  // namespace

std::string calibration_text(const Calibration& calibration) {
  MAREY_ASSERT(calibration.cameras.size() == calibration.quality.size());
  MAREY_ASSERT(calibration.cameras.size() == calibration.clocks.size());
  TomlWriter out;
  out.comment("Cameras. World: right-handed, Y up, metres. rotation (Rodrigues) and");
  out.comment("translation are camera_from_world; camera x right, y down, z forward.");
  for (std::size_t i = 0; i < calibration.cameras.size(); ++i) {
    write_camera(
        out, calibration.cameras[i], calibration.quality[i], calibration.clocks[i]);
  }
  out.table({"metadata"});
  out.boolean("adjusted", false);
  out.number("error", calibration.rms_px);
  return out.str();
}

Status write_calibration(const std::filesystem::path& path,
                         const Calibration& calibration) {
  return write_file(path, calibration_text(calibration));
}

Result<Calibration> parse_calibration(std::string_view text, const std::string& file) {
  Result<TomlDocument> document = parse_toml(text, file, "calibration.md");
  if (!document) return document.error();
  TomlReader root(*document);
  Calibration calibration;
  // Caliscope's camera_array.toml has [cameras.0], [cameras.1]...
  const bool is_array = root.is_table("cameras") && !root.table("cameras").has("matrix");
  TomlReader cameras = is_array ? root.table("cameras") : root;
  std::set<std::string> names;
  for (const std::string& key : cameras.keys()) {
    if (!root.ok()) break;
    if (!is_camera(key) || !cameras.is_table(key)) continue;
    TomlReader camera = cameras.table(key);
    if (camera.has("ignore") && camera.boolean("ignore")) continue;
    read_camera(camera, key, names, calibration);
  }
  if (calibration.cameras.empty()) {
    root.fail("", "no camera in it", "run marey calibrate, or name another file");
  }
  if (root.is_table("metadata")) {
    TomlReader metadata = root.table("metadata");
    read_if_there(metadata, "error", kNotNegative, calibration.rms_px);
  }
  if (document->mistake) return mistake_of(*document, TomlKind::kCalibration);
  return calibration;
}

namespace {

Result<Calibration> read_parts(const std::filesystem::path& path, CameraParts parts) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  if (is_yaml_or_xml(*text)) return import_calibration(*text, path, parts);
  return parse_calibration(*text, path.string());
}

}  // namespace

Result<Calibration> read_calibration(const std::filesystem::path& path) {
  return read_parts(path, CameraParts::kAll);
}

Result<Calibration> read_lenses(const std::filesystem::path& path) {
  return read_parts(path, CameraParts::kLenses);
}

bool is_calibration(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return false;
  if (is_yaml_or_xml(*text)) return true;
  Result<TomlDocument> document = parse_toml(*text, path.string(), "calibration.md");
  return document && toml_kind(*document) == TomlKind::kCalibration;
}

}  // namespace marey::recordings
