// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/opencv_xml.h"
#include "recordings/base/yaml_reader.h"
#include "recordings/session/calibration_import.h"
#include "recordings/session/camera_numbers.h"

namespace marey::recordings {
namespace {

using Keys = std::span<const std::string_view>;

// Names used by the samples of cv::calibrateCamera and cv::stereoCalibrate and by the
// manual.
constexpr auto kMatrix = std::to_array<std::string_view>(
    {"camera_matrix", "cameraMatrix", "Camera_Matrix", "M", "K", "mtx"});
constexpr auto kTerms = std::to_array<std::string_view>({"distortion_coefficients",
                                                         "Distortion_Coefficients",
                                                         "distCoeffs",
                                                         "dist_coeffs",
                                                         "D",
                                                         "dist"});
constexpr auto kMatrix1 =
    std::to_array<std::string_view>({"M1", "K1", "cameraMatrix1", "camera_matrix_1"});
constexpr auto kTerms1 =
    std::to_array<std::string_view>({"D1", "distCoeffs1", "dist_coeffs_1"});
constexpr auto kMatrix2 =
    std::to_array<std::string_view>({"M2", "K2", "cameraMatrix2", "camera_matrix_2"});
constexpr auto kTerms2 =
    std::to_array<std::string_view>({"D2", "distCoeffs2", "dist_coeffs_2"});

/// Maximum distance of two cameras of one rig; larger distances are in millimetres. [m]
constexpr double kMaxPairDistance_m = 20.0;

/// Returns the first of `keys` that the file has; empty if it has none.
std::string_view first_of(const TomlReader& in, Keys keys) {
  for (const std::string_view key : keys) {
    if (in.has(key)) return key;
  }
  return {};
}

/// Returns the numbers of a matrix of any shape, row after row.
std::vector<double> matrix_at(TomlReader& in, std::string_view key) {
  TomlReader matrix = in.table(key);
  const std::size_t count = matrix.count("data");
  constexpr Limits kSide{0, 1e6};
  const double expected =
      static_cast<double>(matrix.integer("rows", kSide)) * matrix.integer("cols", kSide);
  if (expected != static_cast<double>(count)) {
    matrix.fail(
        "data",
        in_quotes(key) + " has another number of values than its rows and cols state",
        "copy the file again");
  }
  return matrix.numbers("data", count);
}

void read_image_size(TomlReader& in, Intrinsics& k) {
  constexpr Limits kSide{1, 1e5, "px"};
  if (in.has("image_size")) {
    const std::vector<double> size = in.numbers("image_size", 2);
    if (!(size[0] >= 1 && size[0] <= 1e5 && size[1] >= 1 && size[1] <= 1e5)) {
      in.fail("image_size", "\"image_size\" is not a picture size", "correct it");
      return;
    }
    k.width_px = static_cast<int>(size[0]);
    k.height_px = static_cast<int>(size[1]);
  } else if (in.has("image_Width") && in.has("image_Height")) {
    k.width_px = in.integer("image_Width", kSide);
    k.height_px = in.integer("image_Height", kSide);
  } else if (in.has("image_width") && in.has("image_height")) {
    k.width_px = in.integer("image_width", kSide);
    k.height_px = in.integer("image_height", kSide);
  } else {
    in.fail("",
            "the file does not state how large the pictures are",
            "add the keys image_width and image_height, in pixels");
  }
}

bool is_fisheye(TomlReader& in) {
  constexpr Limits kFlag{0, 1};
  if (in.has("fisheye_model")) return in.integer("fisheye_model", kFlag) != 0;
  // ROS adds this key to OpenCV's keys.
  if (!in.has("distortion_model")) return false;
  const std::string model = in.text("distortion_model");
  return model == "equidistant" || model == "fisheye";
}

Intrinsics read_lens(TomlReader& in, Keys matrix_keys, Keys terms_keys) {
  Intrinsics k;
  read_image_size(in, k);
  const std::string_view matrix_key = first_of(in, matrix_keys);
  std::vector<double> matrix = matrix_at(in, matrix_key);
  matrix.resize(9);
  if (!set_pinhole(std::span<const double, 9>(matrix.data(), 9), k)) {
    in.fail(matrix_key,
            in_quotes(matrix_key) + " must be [fx, 0, cx, 0, fy, cy, 0, 0, 1]",
            "calibrate without skew");
  }
  const std::string_view terms_key = first_of(in, terms_keys);
  if (terms_key.empty()) {
    in.fail("",
            "the lens of " + in_quotes(matrix_key) + " has no distortion coefficients",
            "add them, zeros if it has none");
    return k;
  }
  if (!set_distortion(matrix_at(in, terms_key), is_fisheye(in), k)) {
    in.fail(terms_key,
            in_quotes(terms_key) + " holds terms that marey's lenses do not have",
            "calibrate with 4, 5 or 8 of them, without thin prisms or tilt; a fisheye "
            "has 4 and fisheye_model: 1");
  }
  return k;
}

/// R, a matrix or a rotation vector, and T: x_in_camera = R * x_in_world + T, or from the
/// first camera to the second.
RigidTransform read_pair_pose(TomlReader& in) {
  RigidTransform camera_from_world;
  const std::vector<double> r = matrix_at(in, "R");
  const std::vector<double> t = matrix_at(in, "T");
  std::optional<glm::dquat> rotation;
  if (r.size() == 9) {
    rotation = rotation_of_rows(std::span<const double, 9>(r.data(), 9));
  } else if (r.size() == 3) {
    rotation = rotation_from_vector({r[0], r[1], r[2]});
  }
  if (!rotation) {
    in.fail("R", "\"R\" is not a rotation", "copy it from the calibration again");
  } else if (t.size() != 3) {
    in.fail("T", "\"T\" must have three numbers", "copy it from the calibration again");
  } else {
    camera_from_world = {*rotation, {t[0], t[1], t[2]}};
  }
  return camera_from_world;
}

bool has_pose(const TomlReader& in) {
  return in.has("R") && in.has("T");
}

/// OpenCV's stereo sample writes R and T into a separate file next to the lenses.
Result<RigidTransform> read_pair(TomlReader& in, const std::filesystem::path& path) {
  if (has_pose(in)) return read_pair_pose(in);
  for (const char* name : {"extrinsics.yml", "extrinsics.yaml", "extrinsics.xml"}) {
    const std::filesystem::path other_file = path.parent_path() / name;
    std::error_code ignored;
    if (!std::filesystem::exists(other_file, ignored)) continue;
    const Result<std::string> text = read_file(other_file);
    if (!text) return text.error();
    Result<TomlDocument> document = other_file.extension() == ".xml"
                                        ? parse_opencv_xml(*text, other_file.string())
                                        : parse_yaml(*text, other_file.string());
    if (!document) return document.error();
    TomlReader root(*document);
    const RigidTransform second_from_first = read_pair_pose(root);
    if (document->mistake) return *document->mistake;
    return second_from_first;
  }
  in.fail(
      "",
      "the pose of the second camera is missing: the file has no R and T",
      "add R and T as cv::stereoCalibrate gives them, or put extrinsics.yml with them "
      "into the same folder");
  return RigidTransform{};
}

}  // namespace

bool is_opencv(const TomlReader& root) {
  const std::string_view one = first_of(root, kMatrix);
  const std::string_view pair = first_of(root, kMatrix1);
  return (!one.empty() && root.is_table(one)) || (!pair.empty() && root.is_table(pair));
}

Status import_opencv(TomlReader& root,
                     const std::filesystem::path& path,
                     Calibration& out) {
  if (first_of(root, kMatrix1).empty()) {
    Camera only;
    only.name = root.has("camera_name") ? root.text("camera_name") : "cam1";
    only.intrinsics = read_lens(root, kMatrix, kTerms);
    if (has_pose(root)) only.camera_from_world = read_pair_pose(root);
    out.cameras.push_back(std::move(only));
    return Done{};
  }
  if (first_of(root, kMatrix2).empty()) {
    root.fail(
        "", "it has a first camera's matrix and no second's", "copy M2 and D2 also");
    return Done{};
  }
  Camera first;
  first.name = "cam1";
  first.intrinsics = read_lens(root, kMatrix1, kTerms1);
  Camera second;
  second.name = "cam2";
  second.intrinsics = read_lens(root, kMatrix2, kTerms2);
  const auto second_from_first = read_pair(root, path);
  if (!second_from_first) return second_from_first.error();
  second.camera_from_world = *second_from_first;
  if (glm::length(second_from_first->translation) > kMaxPairDistance_m) {
    root.fail("T",
              "T puts the second camera more than 20 m from the first",
              "give T in metres: divide it by 1000 if it is in millimetres");
  }
  out.cameras = {std::move(first), std::move(second)};
  return Done{};
}

}  // namespace marey::recordings
