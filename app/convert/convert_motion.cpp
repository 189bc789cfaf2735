// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/convert/convert_motion.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/motion/angle_table.h"
#include "app/motion/error_of_file.h"
#include "app/motion/motion_files.h"
#include "app/motion/neutral.h"
#include "app/motion/read_body.h"
#include "app/motion/retarget_files.h"
#include "core/base/extension.h"
#include "core/resample.h"
#include "recordings/markers/file_axes.h"
#include "recordings/motion/asf.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/mot.h"
#include "retarget/bones/body_frame.h"
#include "retarget/bones/identify_bones.h"

namespace marey::app {
namespace {

/// A motion as in its file, with notes to the user.
struct FileMotion {
  Motion motion;
  double ignored_translation_m = 0.0;
  std::vector<std::string> notes;
  retarget::FileUnit unit;
};

std::optional<double> unit_m(const std::string& name) {
  const auto per_metre = recordings::units_per_metre(name);
  return per_metre ? std::optional(1.0 / *per_metre) : std::nullopt;
}

Result<FileMotion> read_bvh(const ConvertArguments& arguments) {
  recordings::BvhReadOptions options;
  options.unit_m = unit_m(arguments.unit).value_or(options.unit_m);
  auto bvh = recordings::read_bvh(arguments.in, options);
  if (!bvh) return bvh.error();
  // Bodies written by marey may have any stature, so their unit is not estimated.
  const bool is_ours =
      std::ranges::all_of(bvh->motion.skeleton.joints,
                          [](const Joint& joint) { return joint.bone.has_value(); });
  return FileMotion{std::move(bvh->motion),
                    bvh->ignored_translation_m,
                    {},
                    {options.unit_m, is_ours || !arguments.unit.empty()}};
}

Result<FileMotion> read_acclaim(const ConvertArguments& arguments) {
  const auto path = arguments.skeleton.empty()
                        ? recordings::find_skeleton_file(arguments.in)
                        : std::optional(arguments.skeleton);
  if (!path) {
    return bad_input(arguments.in.string(),
                     "the .asf file of this motion is not in the same folder",
                     "name it: --skeleton FILE.asf");
  }
  const auto skeleton = recordings::read_asf(*path, {.unit_m = unit_m(arguments.unit)});
  if (!skeleton) return skeleton.error();
  recordings::AmcReadOptions options;
  if (arguments.rate_hz) options.rate = FrameRate{*arguments.rate_hz};
  auto amc = recordings::read_amc(arguments.in, *skeleton, options);
  if (!amc) return amc.error();
  FileMotion read{std::move(amc->motion), amc->ignored_translation_m, {}, {}};
  if (amc->rate_is_guessed) {
    read.notes.emplace_back(
        "the file does not state its rate: 120 Hz is assumed; --rate sets another");
  }
  return read;
}

Result<FileMotion> read(const ConvertArguments& arguments) {
  const std::string kind = kind_by_extension(arguments.in);
  if (kind == ".bvh") return read_bvh(arguments);
  if (kind == ".amc") return read_acclaim(arguments);
  if (!arguments.unit.empty()) {
    return bad_input(
        arguments.in.string(),
        std::string(kind == ".npz" ? "NPZ" : "glTF") + " is always in metres",
        "leave out --unit");
  }
  auto raw = read_raw_body(arguments.in);
  if (!raw) return raw.error();
  if (!raw->has_motion) {
    return bad_input(
        arguments.in.string(), "holds no animation", "give a file with a motion");
  }
  FileMotion read{std::move(raw->motion), raw->ignored_translation_m, {}, raw->unit};
  if (kind == ".npz") {
    read.notes.emplace_back(
        "NPZ does not hold the ends of the last bones (head, hands, toes), and its "
        "sigmas "
        "and contacts are not converted");
  }
  return read;
}

/// Sets the rest pose of --neutral, in the file's own frame.
Status take_neutral(const ConvertArguments& arguments, Motion& motion) {
  const auto neutral = read_neutral(arguments.neutral);
  if (!neutral) return neutral.error();
  const auto bones = retarget::identify_bones(motion.skeleton);
  const auto taken = bones ? set_neutral(*neutral, *bones, motion) : bones.error();
  if (taken) return Done{};
  return of_file(arguments.in, taken.error());
}

Error cannot(const ConvertArguments& arguments, std::string cause, std::string next) {
  return bad_input(arguments.out.string(), std::move(cause), std::move(next));
}

/// Writes a BVH. If the dialect has names for bones, all identified bones get them.
Status write_as_bvh(const ConvertArguments& arguments,
                    const Motion& motion,
                    Console& console) {
  recordings::BvhWriteOptions options;
  if (const auto dialect = recordings::bvh_dialect(arguments.bvh_dialect)) {
    options = recordings::write_options(*dialect);
  }
  options.unit_m = unit_m(arguments.to_unit).value_or(options.unit_m);
  if (options.names == recordings::BvhNames::kOwn) {
    return recordings::write_bvh(arguments.out, motion, options);
  }
  // Bones are identified as in all readers; the frame stays that of the file.
  RawBody raw;
  raw.motion = motion;
  raw.has_motion = true;
  Motion named = motion;
  if (const auto body = identify_body(std::move(raw), arguments.in)) {
    retarget::mark(body->bones, named.skeleton);
  } else {
    console.warn(arguments.in.string() +
                 ": joints keep their names: " + body.error().message());
  }
  return recordings::write_bvh(arguments.out, named, options);
}

/// Writes the motion as VRMA: bones identified, facing +Z, in metres.
Status write_as_vrma(const ConvertArguments& arguments,
                     const FileMotion& file,
                     Console& console) {
  RawBody raw;
  raw.motion = file.motion;
  raw.has_motion = true;
  raw.unit = file.unit;
  BodyFile in(arguments.in);
  if (!arguments.neutral.empty()) {
    const auto neutral = read_neutral(arguments.neutral);
    if (!neutral) return neutral.error();
    in.neutral = *neutral;
  }
  const auto body = identify_body(std::move(raw), in);
  if (!body) return body.error();
  for (const std::string& remark : body->remarks()) {
    console.warn(arguments.in.string() + ": " + remark);
  }
  return write_motion_file(arguments.out,
                           MotionFormat::kVrma,
                           body->raw.motion,
                           {},
                           {.bvh = {}, .clip = arguments.out.stem().string()});
}

Status write_as_mot(const ConvertArguments& arguments, const Motion& motion) {
  const auto table = angle_table(motion, arguments.out.stem().string());
  if (table) return recordings::write_mot(arguments.out, *table);
  return cannot(arguments,
                "joint angles need a body as marey writes it: all 22 bones of VRM's "
                "humanoid, at rest without rotations",
                "retarget the motion to such a body first: marey retarget");
}

Status write(const ConvertArguments& arguments,
             const FileMotion& file,
             Console& console) {
  const Motion& motion = file.motion;
  const std::string kind = kind_by_extension(arguments.out);
  if (kind != ".bvh" && !(arguments.bvh_dialect.empty() && arguments.to_unit.empty())) {
    return cannot(arguments,
                  "only a .bvh is written in a dialect or a unit",
                  "leave out --bvh-dialect and --to-unit");
  }
  if (kind == ".bvh") return write_as_bvh(arguments, motion, console);
  if (kind == ".vrma") return write_as_vrma(arguments, file, console);
  if (kind == ".npz") {
    return write_motion_file(arguments.out, MotionFormat::kNpz, motion, {});
  }
  if (kind == ".csv") {
    return write_motion_file(arguments.out, MotionFormat::kCsv, motion, {});
  }
  if (kind == ".mot") return write_as_mot(arguments, motion);
  return cannot(arguments,
                "cannot write a motion as \"" + kind + "\"",
                "name the result .bvh, .vrma, .npz, .csv or .mot; marey retarget writes "
                ".glb");
}

void report_conversion(const ConvertArguments& arguments,
                       const FileMotion& read,
                       bool json,
                       Console& console) {
  const auto& [skeleton, rate, first_frame, poses] = read.motion;
  const auto bones = std::ranges::count_if(
      skeleton.joints, [](const Joint& joint) { return joint.bone.has_value(); });
  if (json) {
    const nlohmann::ordered_json figures{{"out", arguments.out.string()},
                                         {"joints", skeleton.joints.size()},
                                         {"human_bones", bones},
                                         {"frames", poses.size()},
                                         {"rate_hz", rate.hz},
                                         {"notes", read.notes}};
    std::printf(
        "%s\n",
        figures.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
            .c_str());
  }
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%.6g", rate.hz);
  console.say(arguments.out.string() + ": " + std::to_string(skeleton.joints.size()) +
              " joints, " + std::to_string(poses.size()) + " frames at " + digits.data() +
              " Hz");
}

}  // namespace

Exit convert_motion(const ConvertArguments& arguments, Console& console) {
  if (!arguments.up.empty() || !arguments.to_up.empty()) {
    return console.fail(bad_input(arguments.in.string(),
                                  "motions of skeletons are always Y up",
                                  "leave out --up and --to-up"));
  }
  auto file = read(arguments);
  if (!file) return console.fail(file.error());
  if (const auto note = left_out({file->motion, file->ignored_translation_m})) {
    file->notes.push_back(*note);
  }
  for (const std::string& note : file->notes) {
    console.warn(arguments.in.string() + ": " + note);
  }
  Motion& motion = file->motion;
  if (arguments.rate_hz) motion.rate = FrameRate{*arguments.rate_hz};
  if (arguments.to_rate_hz) {
    motion = resample(motion, FrameRate{*arguments.to_rate_hz});
    if (motion.poses.empty()) {
      return console.fail(bad_input(arguments.in.string(),
                                    "the motion is shorter than a frame at that rate",
                                    "give a higher --to-rate"));
    }
  }
  const bool is_vrma = kind_by_extension(arguments.out) == ".vrma";
  if (!arguments.neutral.empty() && !is_vrma) {
    if (const Status ok = take_neutral(arguments, motion); !ok) {
      return console.fail(ok.error());
    }
  }
  const Status written = write(arguments, *file, console);
  if (!written) return console.fail(written.error());
  report_conversion(arguments, *file, arguments.json, console);
  return Exit::kOk;
}

}  // namespace marey::app
