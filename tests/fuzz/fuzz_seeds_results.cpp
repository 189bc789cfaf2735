// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz_seeds_results.h"

#include <string>
#include <system_error>
#include <vector>

#include "recordings/base/atomic_file.h"
#include "recordings/gltf/vrma.h"
#include "recordings/motion/npz.h"
#include "recordings/takes/live_take.h"
#include "recordings/takes/take_file.h"

namespace marey::fuzz {
namespace {

using namespace marey::recordings;
namespace fs = std::filesystem;

bool write_npz_seeds(const fs::path& folder, Motion motion) {
  // Fuzzing is the faster the smaller its files are.
  motion.skeleton.joints.resize(3);
  for (Pose& pose : motion.poses) pose.parent_from_joint.resize(3);
  const std::vector<std::vector<JointUncertainty>> uncertainty(
      motion.poses.size(), std::vector<JointUncertainty>(3, {0.001, Source::kRepaired}));
  const NpzContacts contacts{{"leftFoot"}, {1, 0}};
  return write_npz(folder / "plain.npz", motion).has_value() &&
         write_npz(folder / "all.npz", motion, {uncertainty, contacts, 1.5}).has_value();
}

bool write_take_seeds(const fs::path& folder) {
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  fs::remove(folder / "take", ignored);
  fs::remove(folder / "live", ignored);
  Take take;
  take.trial = "walk";
  take.cameras.push_back({"cam0", "cam0.mkv", 640, 480, {30.0}, "/dev/video0", "", {}});
  auto writer = TakeWriter::create(folder / "take", take);
  if (!writer) return false;
  for (int i = 0; i < 5; ++i) {
    writer->add(0, {Timestamp{i * 1000}, false, static_cast<std::uint32_t>(i), 0, false});
  }
  writer->note({0, Timestamp{7}, "lost"});
  auto live = LiveTakeWriter::create(folder / "live", {"a", "b", {30.0}, {"left"}, "{}"});
  if (!live) return false;
  CameraTags view{CameraId{0}, Timestamp{5}, {TagDetection{}}};
  view.tags[0].sigma_px = 0.5;
  for (int i = 0; i < 3; ++i) {
    if (!live->add({{i, Timestamp{i}, {view}}, "", {std::byte{1}}})) return false;
  }
  return writer->finish().has_value() && live->finish().has_value();
}

bool write_setting_seeds(const fs::path& folder) {
  const std::string plan =
      "format = 1\ntag_size_m = 0.08\n[volume]\nleast_m = [-1, -1]\ngreatest_m = [1, 1]\n"
      "step_m = 0.5\n[[tag]]\nsegment = \"hips\"\n[[camera]]\nname = \"a\"\n"
      "place_m = [0, 1.4, 3.0]\nlooks_at_m = [0, 0.9, 0]\nwidth_px = 1280\n"
      "height_px = 720\nfield_of_view_deg = 70\n";
  const std::string body =
      "format = 1\nname = \"a\"\nstature_m = 1.7\nmass_kg = 70\nmass_table = \"deLeva\"\n"
      "[limits.leftLowerArm]\nmin_deg = [0, 0, 0]\nmax_deg = [1, 2, 3]\n[[load]]\n"
      "name = 'l'\nsegment = \"hips\"\noffset_m = [0, 0, 0]\nmass_kg = 1\n";
  const std::string floor =
      "format = 1\nbase_m = 0.5\n[[part]]\nname = \"\"\"b\"\"\"\nx_m = [0, 1]\n"
      "z_m = [0, 1]\ntop_m = 0.2\ntimes_s = [0, 1]\nmoved_m = [[0, 0, 0], [0, 1, 0]]\n";
  return write_file(folder / "plan", plan).has_value() &&
         write_file(folder / "body", body).has_value() &&
         write_file(folder / "floor", floor).has_value() &&
         write_file(folder / "bones",
                    "unit_m = 0.01\nup = \"+Y\"\n[bones]\nhips = 'hips'\n")
             .has_value() &&
         write_file(folder / "markers", "[markers]\nLASI = \"ignore\"\na.b.c = 1\n")
             .has_value();
}

/// The first byte selects the format of the rest: 0 TOML, 1 YAML, 2 XML.
bool write_calibration_seeds(const fs::path& folder) {
  const std::string toml =
      "[cam0]\nname = \"a\"\nsize = [640, 480]\nmatrix = [[500.0, 0.0, 320.0], [0.0, "
      "500.0,"
      " 240.0], [0.0, 0.0, 1.0]]\ndistortions = [0.1, 0.0, 0.0, 0.0]\n"
      "rotation = [0.0, 0.0, 0.0]\ntranslation = [0.0, 0.0, 1.0]\n";
  const std::string yaml =
      "%YAML:1.0\nimage_width: 640\nimage_height: 480\nM1: &a !!opencv-matrix\n   rows: "
      "3\n"
      "   cols: 3\n   dt: d\n   data: [ 550., 0., 320., 0., 550., 240., 0., 0., 1. ]\n"
      "D1: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: d\n   data: [ 0., 0, 1e-1, .5 "
      "]\n";
  const std::string chain =
      "cam0:\n  camera_model: pinhole\n  distortion_model: radtan\n  resolution: [640, "
      "480]\n"
      "  intrinsics: [500, 500, 320, 240]\n  distortion_coeffs: [0, 0, 0, 0]\n";
  const std::string xml =
      "<?xml "
      "version=\"1.0\"?><opencv_storage><image_width>640</image_width><image_height>"
      "480</image_height><camera_matrix type_id=\"opencv-matrix\"><rows>3</rows><cols>3"
      "</cols><dt>d</dt><data>550 0 320 0 550 240 0 0 1</data></camera_matrix></"
      "opencv_storage>";
  using namespace std::string_literals;
  return write_file(folder / "toml", "\0"s + toml).has_value() &&
         write_file(folder / "yaml", "\1"s + yaml).has_value() &&
         write_file(folder / "chain", "\1"s + chain).has_value() &&
         write_file(folder / "xml", "\2"s + xml).has_value();
}

bool write_label_seeds(const fs::path& folder) {
  const std::string labels =
      "clip_or_source,start_s,end_s,label,by,sure\r\n"
      "walks/a.bvh,0.5,2,\"turn, "
      "\"\"left\"\"\",anna,0.5\r\n0123456789abcdef,,,clap,,\r\n";
  const std::string verdicts =
      "clip,figure,frames,verdict,by,note\n0123456789abcdef,slide_cm_s,5-9,pass,bo,a\n";
  const std::string babel =
      R"({"1":{"feat_p":"C/C/1/a_poses.npz","seq_ann":{"labels":[{"proc_label":"walk",)"
      R"("act_cat":["walk"]}]},"frame_ann":{"labels":[{"raw_label":"b","start_t":0,)"
      R"("end_t":1.5}]},"seq_anns":[],"frame_anns":null}})";
  return write_file(folder / "labels.csv", labels).has_value() &&
         write_file(folder / "verdicts.csv", verdicts).has_value() &&
         write_file(folder / "babel.json", babel).has_value();
}

}  // namespace

bool write_result_seeds(const fs::path& folder, const Motion& motion) {
  return write_npz_seeds(folder / "npz", motion) && write_take_seeds(folder / "take") &&
         write_setting_seeds(folder / "settings") &&
         write_calibration_seeds(folder / "calibration") &&
         write_label_seeds(folder / "labels") &&
         write_vrma(folder / "vrma/motion.vrma", motion).has_value() &&
         write_file(folder / "report/report",
                    R"({"summary":{"a":[1,2.5e3,[[]],{"b":"\"[{\u00e9"}]},"x":null})")
             .has_value();
}

}  // namespace marey::fuzz
