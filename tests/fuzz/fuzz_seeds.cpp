// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// fuzz_seeds FOLDER: writes small sound files into FOLDER/c3d and so on, a folder for
// each fuzzer, from which fuzzing starts.
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/constraints_file.h"
#include "recordings/gltf/gltf.h"
#include "recordings/gltf/vrma.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/marker_file.h"
#include "recordings/markers/trc.h"
#include "recordings/motion/bvh.h"
#include "recordings/moves/write_moves.h"
#include "tests/fuzz/fuzz_seeds_edits.h"
#include "tests/fuzz/fuzz_seeds_osc.h"
#include "tests/fuzz/fuzz_seeds_results.h"
#include "tests/support/files/random_moves.h"

namespace {

using namespace marey;
using namespace marey::recordings;

MarkerFile two_markers() {
  MarkerFile markers;
  markers.tracks.labels = {"LHEE", "RHEE"};
  markers.tracks.rate = FrameRate{100.0};
  markers.tracks.samples.resize(6);
  markers.tracks.samples[0] = MarkerSample{{0.1, 0.2, 0.3}, 0.001F, 5, {}};
  markers.tracks.samples[3] = MarkerSample{{0.1, 1.2, 0.3}, 0.0F, 0, Source::kRepaired};
  markers.events.push_back({"Foot Strike", "Left", "A", 0.01});
  return markers;
}

C3dParameter reals(const char* name, std::vector<std::uint8_t> dimensions) {
  std::size_t count = 1;
  for (const std::uint8_t d : dimensions) count *= d;
  return {name, "", false, std::move(dimensions), C3dReals(count, 1.5F)};
}

C3dParameter integers(const char* name, std::vector<std::uint8_t> dimensions) {
  std::size_t count = 1;
  for (const std::uint8_t d : dimensions) count *= d;
  return {name, "", false, std::move(dimensions), C3dIntegers(count, 2)};
}

C3dInfo example(C3dProcessor processor, C3dNumbers numbers) {
  C3dInfo info;
  info.processor = processor;
  info.numbers = numbers;
  info.points = 2;
  info.analog_channels = 6;
  info.analog_per_frame = 2;
  info.frames = 2;
  info.header_events.push_back({"LHS", 0.01, true});
  put_texts(info.groups, "POINT", "LABELS", {"LHEE", "RHEE"});
  put_texts(info.groups, "POINT", "UNITS", {"mm"});
  put_texts(info.groups, "POINT", "Y_SCREEN", {"+Z"});
  put_parameter(info.groups, "ANALOG", reals("SCALE", {6}));
  put_parameter(info.groups, "ANALOG", integers("OFFSET", {6}));
  put_parameter(info.groups, "ANALOG", reals("GEN_SCALE", {}));
  put_parameter(info.groups, "FORCE_PLATFORM", integers("USED", {}));
  put_parameter(info.groups, "FORCE_PLATFORM", integers("TYPE", {1}));
  put_parameter(info.groups, "FORCE_PLATFORM", reals("CORNERS", {3, 4, 1}));
  put_parameter(info.groups, "FORCE_PLATFORM", reals("ORIGIN", {3, 1}));
  put_parameter(info.groups, "FORCE_PLATFORM", integers("CHANNEL", {6, 1}));
  put_parameter(info.groups, "EVENT", reals("TIMES", {2, 1}));
  return info;
}

bool write_c3d(const std::filesystem::path& path, const C3dInfo& info) {
  Result<C3dWriter> writer = C3dWriter::create(path, info);
  if (!writer) return false;
  C3dFrame frame;
  frame.points = {100, 200, 300, 261, 0, 0, 0, -1};
  frame.analog.assign(12, 3.0F);
  for (int i = 0; i < info.frames; ++i) writer->append(frame);
  return writer->commit().has_value();
}

/// One constraint of every type, with all that it may say.
bool write_constraint_sets(const std::filesystem::path& folder) {
  const glm::dvec3 p(0.1, 1.2, -0.3);
  const glm::dquat turned(0.6, 0.0, 0.8, 0.0);
  ConstraintSet set;
  for (const Goal& goal : {Goal(DistanceToPoint{0.1, p}),
                           Goal(DistanceToBody{0.1, {"head", p}}),
                           Goal(DistanceToConstraint{0.1, "c0"}),
                           Goal(AllowedSpace{-p, p}),
                           Goal(ForbiddenSpace{-p, p}),
                           Goal(SegmentOrientation{turned}),
                           Goal(Support{p, turned})}) {
    Constraint& c = set.constraints.emplace_back();
    c.id = "c" + std::to_string(set.constraints.size() - 1);
    c.point = {"leftFoot", p};
    c.goal = goal;
    c.range = 3;
    c.activation = {0.5, 1.5, 0.1, 0.2};
    c.unknown_xml = {"<a x='>'><!-- > --><![CDATA[</a>]]></a>"};
  }
  const std::string z_up =
      "<ConstraintsSet up=\"Z\"><Gaze/><Support><name>a&amp;&#233;</name><bodyPoint>"
      "<segment>leftAnkle</segment></bodyPoint></Support></ConstraintsSet>";
  return write_constraints(folder / "all.xml", set).has_value() &&
         write_file(folder / "z_up.xml", z_up).has_value();
}

/// Two frames of a small body, the second one turned.
Motion small_motion() {
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.7));
  motion.rate.hz = 29.97;
  motion.poses = {rest_pose(motion.skeleton), rest_pose(motion.skeleton)};
  motion.poses[1].parent_from_joint[0] = glm::dquat(0.6, 0.0, 0.8, 0.0);
  return motion;
}

/// A triangle that hangs on three joints.
SkinnedMesh triangle() {
  SkinnedMesh mesh;
  mesh.p_in_world = {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}};
  mesh.normal_in_world.assign(3, {0.0, 0.0, 1.0});
  mesh.skin.resize(3);
  for (int i = 0; i < 3; ++i) {
    auto& skin = mesh.skin[static_cast<std::size_t>(i)];
    skin.joints[0] = JointIndex{i};
    skin.weights[0] = 1.0;
  }
  mesh.parts.resize(1);
  mesh.parts[0].triangles = {0, 1, 2};
  return mesh;
}

bool write_motions(const std::filesystem::path& folder) {
  const Motion motion = small_motion();
  const std::string max =
      "HIERARCHY\r\nROOT Bip01 Pelvis\r\n{\r\n\tOFFSET 0.00 9.5e1 0\r\n"
      "\tCHANNELS 6 Zposition Xposition Yposition Xrotation Yrotation Zrotation\r\n"
      "\tJOINT a:b\r\n\t{\r\n\tOFFSET -1 .5 0\r\n\tCHANNELS 1 Xrotation\r\n"
      "\tEnd Site\r\n\t{\r\n\tOFFSET 0 1 0\r\n\t}\r\n\t}\r\n}\r\nMotion\r\nFrames: 2\r\n"
      "Frame Time:.04\r\n0 1 2 90 0 -45 1\r\n3 2 1 0 1 2 3\r\n";
  const std::string acclaim =
      "# x\n:version 1.10\n:name a\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n"
      ":documentation\n   words\n:root\n   order TX TY TZ RX RY RZ\n   axis XYZ\n"
      "   position 0 0 0\n   orientation 0 0 0\n:bonedata\n  begin\n     id 1\n"
      "     name hip\n     direction 1 0 0\n     length 2\n     axis 0 0 0 XYZ\n  end\n"
      "  begin\n     id 2\n     name thigh\n     direction 0 -3 0\n     length 4\n"
      "     axis 0 10 90 ZXY\n    dof rx tz l\n    limits (-160.0 20.0)\n"
      "           (-70.0 70.0)\n           (0 1)\n  end\n:hierarchy\n  begin\n"
      "    root hip\n    hip thigh\n  end\n@#x\n:FULLY-SPECIFIED\n:DEGREES\n"
      ":SAMPLES-PER-SECOND 60\n1\nroot 1 2 3 40 50 60\nthigh 30 1 0.5\n2\n"
      "root 1 2 3 40 50 60\nthigh -30 1e-3 0\n";
  // Fuzzing is the faster the smaller its files are.
  Motion trunk = motion;
  trunk.skeleton.joints.resize(3);
  for (Pose& pose : trunk.poses) pose.parent_from_joint.resize(3);
  return write_bvh(folder / "bvh/blender.bvh", motion).has_value() &&
         write_file(folder / "bvh/max.bvh", max).has_value() &&
         write_file(folder / "asf/all", acclaim).has_value() &&
         write_vrma(folder / "gltf/motion.vrma", motion).has_value() &&
         write_character(folder / "gltf/mesh.glb", trunk.skeleton, triangle(), &trunk)
             .has_value();
}

bool write_all(const std::filesystem::path& folder) {
  const MarkerFile markers = two_markers();
  bool ok = write_markers(folder / "c3d/markers.c3d", markers).has_value() &&
            write_markers(folder / "trc/markers.trc", markers).has_value();
  for (const auto processor :
       {C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips}) {
    for (const auto numbers : {C3dNumbers::kReal, C3dNumbers::kInteger}) {
      const std::string name = std::to_string(static_cast<int>(processor)) +
                               (numbers == C3dNumbers::kReal ? "real" : "integer");
      ok = ok && write_c3d(folder / "c3d" / (name + ".c3d"), example(processor, numbers));
    }
  }
  const std::string odd =
      "PathFileType\t4\t(X/Y/Z)\todd.trc\r\n"
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\r\n"
      "  60.0\t\t60.0\t2\t2\tm\r\n"
      "Frame#\tTimes\t\tA\t\t\tA\t\t\r\n\t\t\tX1\tY1\tZ1\r\n\t\r\n"
      "3\t0,033\t1.5e-1\tNaN\t0.2\t0\t0\t0\r\n5\t0.067\t1\t2\t-3\t1.#QNAN\r\n";
  const std::string opensim =
      "Coordinates\nversion=1\nnRows=2\nnColumns=3\ninDegrees=yes\n\n"
      "Units are S.I. units\n\nendheader\ntime\tknee_angle_r\t/a/hip_flexion_l/value\n"
      "      0.004\t     62.623\t     -0.37e2\n      0.008\t     NaN\t     1.#QNAN\n";
  const std::string simm =
      "first trial\t\t\r\nname a\t\t\r\ndatacolumns 3\r\ndatarows 1\r\notherdata 1\r\n"
      "range 0.4 1.6\r\n# x\r\nendheader \r\n\r\npelvis_tx Time pelvis_tilt\r\n1 0.4 "
      "-9\r\n";
  const std::string drag =
      R"({"type":"drag","id":"left hand","p_in_world":[1,2.5,-3],"phase":"move","frame":12})";
  const std::string request =
      "GET\n/page.js?token=0123456789abcdef0123456789abcdef\n127.0.0.1:8790\n"
      "http://127.0.0.1:8790\nmarey_token=0123456789abcdef0123456789abcdef\n\"5f2c\"";
  return ok && write_file(folder / "page_message/drag", drag).has_value() &&
         write_file(folder / "web_request/request", request).has_value() &&
         write_constraint_sets(folder / "constraints") && write_motions(folder) &&
         fuzz::write_result_seeds(folder, small_motion()) &&
         fuzz::write_edit_seeds(folder / "edit_recipe") &&
         write_moves(folder / "moves/two.marey", testing::random_moves(2, 4, 1))
             .has_value() &&
         write_file(folder / "osc/pose", fuzz::osc_pose()).has_value() &&
         write_file(folder / "osc/commands", fuzz::osc_commands()).has_value() &&
         write_file(folder / "trc/odd.trc", odd).has_value() &&
         write_file(folder / "mot/opensim.mot", opensim).has_value() &&
         write_file(folder / "mot/simm.mot", simm).has_value();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || !write_all(argv[1])) {
    std::fprintf(stderr, "usage: fuzz_seeds FOLDER, which can be written to\n");
    return 1;
  }
  return 0;
}
