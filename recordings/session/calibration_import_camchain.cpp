// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/base/yaml_reader.h"
#include "recordings/session/calibration_import.h"
#include "recordings/session/camera_numbers.h"

namespace marey::recordings {
namespace {

constexpr std::string_view kFromPrevious = "T_cn_cnm1";

std::string camera_key(std::size_t index) {
  std::string key = "cam";
  append_exact(key, static_cast<int>(index));
  return key;
}

void read_resolution(TomlReader& in, Intrinsics& k) {
  const std::vector<double> size = in.numbers("resolution", 2);
  if (in.ok() && !(size[0] >= 1 && size[0] <= 1e5 && size[1] >= 1 && size[1] <= 1e5)) {
    in.fail("resolution", "\"resolution\" is not a picture size", "correct it");
    return;
  }
  k.width_px = static_cast<int>(size[0]);
  k.height_px = static_cast<int>(size[1]);
}

void read_distortion(TomlReader& in, Intrinsics& k) {
  const std::string model = in.text("distortion_model");
  const bool is_fisheye = model == "equidistant";
  const bool is_known = is_fisheye || model == "radtan" || model == "plumb_bob" ||
                        model == "rational_polynomial" || model == "none";
  if (!is_known) {
    in.fail("distortion_model",
            in_quotes(model) + " is a distortion that marey does not have",
            "calibrate with radtan or equidistant");
    return;
  }
  const std::vector<double> terms =
      model == "none" ? std::vector<double>()
                      : in.numbers("distortion_coeffs", in.count("distortion_coeffs"));
  if (set_distortion(terms, is_fisheye, k)) return;
  in.fail("distortion_coeffs",
          "\"distortion_coeffs\" does not have the coefficients of " + in_quotes(model),
          "radtan and equidistant have 4 numbers, plumb_bob 5");
}

Intrinsics read_lens(TomlReader& in) {
  Intrinsics k;
  const std::string model = in.has("camera_model") ? in.text("camera_model") : "pinhole";
  if (model != "pinhole") {
    in.fail("camera_model",
            in_quotes(model) + " is a camera that marey does not have",
            "calibrate with pinhole-radtan or, for a fisheye, pinhole-equi");
  }
  const std::vector<double> numbers = in.numbers("intrinsics", 4);
  k.focal_px = {numbers[0], numbers[1]};
  k.centre_px = {numbers[2], numbers[3]};
  if (!(k.focal_px.x > 0 && k.focal_px.y > 0)) {
    in.fail("intrinsics",
            "\"intrinsics\" must be [fx, fy, cx, cy] with fx and fy above 0",
            "correct it");
  }
  read_resolution(in, k);
  read_distortion(in, k);
  return k;
}

/// Reads Kalibr's transform from the previous camera to this one.
RigidTransform read_link(TomlReader& in) {
  const std::vector<double> m = in.matrix(kFromPrevious, 4, 4);
  const std::vector<double> rows{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
  const auto rotation = rotation_of_rows(std::span<const double, 9>(rows.data(), 9));
  const bool is_rigid = rotation && m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
  if (!is_rigid) {
    in.fail(kFromPrevious,
            "\"T_cn_cnm1\" is not a rotation and a translation",
            "copy it from the calibration again");
    return {};
  }
  return {*rotation, {m[3], m[7], m[11]}};
}

glm::dvec3 read_xyz(TomlReader in) {
  constexpr Limits kAnyNumber{-1e12, 1e12};
  return {
      in.number("x", kAnyNumber), in.number("y", kAnyNumber), in.number("z", kAnyNumber)};
}

/// Sets the poses from TagSLAM's file next to cameras.yaml, in which they are rig from
/// camera.
Status place_by_tagslam(const std::filesystem::path& file, std::vector<Camera>& cameras) {
  const Result<std::string> text = read_file(file);
  if (!text) return text.error();
  Result<TomlDocument> document = parse_yaml(*text, file.string());
  if (!document) return document.error();
  TomlReader root(*document);
  for (Camera& camera : cameras) {
    if (!root.has(camera.name)) {
      root.fail(
          "",
          "where " + camera.name + " stands is not in it",
          "let TagSLAM solve with every camera, or take this one out of cameras.yaml");
    }
    TomlReader pose = root.table(camera.name).table("pose");
    const glm::dvec3 centre_in_rig = read_xyz(pose.table("position"));
    const glm::dvec3 vector_rad = read_xyz(pose.table("rotation"));
    camera.camera_from_world = inverse({rotation_from_vector(vector_rad), centre_in_rig});
  }
  if (document->mistake) return *document->mistake;
  return Done{};
}

void check_rig(TomlReader& root, const std::vector<Camera>& cameras) {
  std::string rig;
  for (const Camera& camera : cameras) {
    TomlReader in = root.table(camera.name);
    const std::string own = in.has("rig_body") ? in.text("rig_body") : "";
    if (&camera != &cameras.front() && own != rig) {
      in.fail("rig_body",
              "the cameras are on different rigs",
              "keep those in the file that are on one, and name them cam0, cam1...");
    }
    rig = own;
  }
}

}  // namespace

bool is_camchain(const TomlReader& root) {
  const std::vector<std::string> keys = root.keys();
  return std::any_of(keys.begin(), keys.end(), [&](const std::string& key) {
    return key.starts_with("cam") && key.find_first_not_of("0123456789", 3) == key.npos &&
           root.is_table(key);
  });
}

Status import_camchain(TomlReader& root,
                       const std::filesystem::path& path,
                       CameraParts parts,
                       Calibration& out) {
  RigidTransform camera_from_first;
  const bool is_chain = root.is_table("cam1") && root.table("cam1").has(kFromPrevious);
  const std::filesystem::path poses = path.parent_path() / "camera_poses.yaml";
  std::error_code ignored;
  const bool wants_places = parts == CameraParts::kAll;
  const bool is_placed =
      wants_places && !is_chain && std::filesystem::exists(poses, ignored);
  const std::size_t count = root.keys().size();
  for (std::size_t i = 0; i < count && root.ok(); ++i) {
    // In order of numbers: in the file cam10 may precede cam2.
    const std::string key = camera_key(i);
    if (i > 0 && !root.has(key)) break;
    TomlReader in = root.table(key);
    Camera camera;
    camera.name = key;
    camera.intrinsics = read_lens(in);
    if (i > 0 && wants_places && !is_placed) {
      if (!in.has(kFromPrevious)) {
        in.fail("",
                "where " + key + " stands is not in it: it has no T_cn_cnm1",
                "name Kalibr's camchain.yaml of all cameras, or put TagSLAM's "
                "camera_poses.yaml into the same folder");
      }
      camera_from_first = read_link(in) * camera_from_first;
      camera.camera_from_world = camera_from_first;
    }
    out.cameras.push_back(std::move(camera));
  }
  for (const std::string& key : root.keys()) {
    if (!root.is_table(key) || !root.table(key).has("intrinsics")) continue;
    const bool is_read = std::any_of(out.cameras.begin(),
                                     out.cameras.end(),
                                     [&](const Camera& c) { return c.name == key; });
    if (!is_read) {
      root.fail(key,
                in_quotes(key) +
                    " does not follow: cameras are cam0, cam1... with none "
                    "left out",
                "number them so");
    }
  }
  if (!root.ok() || !is_placed) return Done{};
  check_rig(root, out.cameras);
  return place_by_tagslam(poses, out.cameras);
}

}  // namespace marey::recordings
