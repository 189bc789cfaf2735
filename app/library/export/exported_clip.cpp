// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/exported_clip.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

#include "edit/ops/mirror.h"
#include "edit/state/edit_state.h"
#include "edit/state/mirror_names.h"
#include "library/export/named_skeleton.h"
#include "library/export/start_at_origin.h"
#include "library/labels/exchange_sides.h"

#include "core/base/in_quotes.h"
#include "core/resample.h"
#include "retarget/body/body_map.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {
namespace {

/// Converts numbers of frames in a clip to another rate.
class FrameNumbers {
 public:
  FrameNumbers(const Motion& from, const Motion& to)
      : from_hz_(from.rate.hz),
        to_hz_(to.rate.hz),
        from_first_(from.first_frame),
        to_first_(to.first_frame),
        last_(static_cast<int>(to.poses.size()) - 1) {}

  /// Nearest frame of the new motion.
  [[nodiscard]] int operator()(int frame) const {
    const double number = (from_first_ + frame) / from_hz_ * to_hz_;
    return std::clamp(static_cast<int>(std::lround(number)) - to_first_, 0, last_);
  }
  [[nodiscard]] FrameRange operator()(const FrameRange& range) const {
    return {(*this)(range.first), (*this)(range.last)};
  }
  /// Time since the first frame of the new motion. [s]
  [[nodiscard]] double time(double since_first_s) const {
    const double moved = from_first_ / from_hz_ - to_first_ / to_hz_ + since_first_s;
    return std::clamp(moved, 0.0, last_ / to_hz_);
  }

 private:
  double from_hz_;
  double to_hz_;
  int from_first_;
  int to_first_;
  int last_;
};

void renumber(ClipRecord& record, const Motion& from, const Motion& to) {
  const FrameNumbers numbers(from, to);
  for (ClipFigure& figure : record.figures) {
    if (figure.frames) figure.frames = numbers(*figure.frames);
  }
  for (ClipProblem& problem : record.problems) problem.frames = numbers(problem.frames);
  for (ClipEvent& event : record.events) event.frame = numbers(event.frame);
  for (ClipLabel& label : record.labels) {
    label.start_s = numbers.time(label.start_s);
    label.end_s = numbers.time(label.end_s);
  }
  record.rate_hz = to.rate.hz;
  record.first_frame = to.first_frame;
  record.last_frame = to.first_frame + static_cast<int>(to.poses.size()) - 1;
}

/// Returns the motion at another rate; contacts and uncertainty are those of the nearest
/// frame.
LibraryMotion at_rate(const LibraryMotion& motion, double rate_hz) {
  LibraryMotion out;
  out.motion = resample(motion.motion, FrameRate{rate_hz});
  if (out.motion.poses.empty()) return out;
  const FrameNumbers back(out.motion, motion.motion);
  for (int i = 0; i < static_cast<int>(out.motion.poses.size()); ++i) {
    const auto from = static_cast<std::size_t>(back(i));
    out.contacts.push_back(motion.contacts[from]);
    if (!motion.uncertainty.empty()) out.uncertainty.push_back(motion.uncertainty[from]);
  }
  return out;
}

Result<LibraryMotion> mirrored_motion(const LibraryMotion& motion) {
  auto state = edit::make_edit_state(motion.motion, motion.uncertainty);
  if (!state) return state.error();
  EditOp op;
  op.parameters = MirrorOp{};
  edit::OpReport report;
  auto mirrored = edit::apply_mirror(MirrorOp{}, {op, 0, {}}, *state, report);
  if (!mirrored) return mirrored.error();
  LibraryMotion out;
  out.motion = std::move(mirrored->motion);
  out.uncertainty = std::move(mirrored->uncertainty);
  out.contacts = motion.contacts;
  for (FootParts& parts : out.contacts) {
    std::swap(parts[0], parts[2]);
    std::swap(parts[1], parts[3]);
  }
  return out;
}

Result<LibraryMotion> on_body(LibraryMotion motion, const ExportBody& body) {
  retarget::RetargetOptions options;
  if (body.avatar) {
    options.soles = body.avatar->soles;
    options.skin = &body.avatar->skin;
    options.hands.emplace().avatar_volume = body.avatar->volume;
  }
  auto put = retarget::retarget_motion(motion.motion, *body.skeleton, options);
  if (!put) return put.error();
  motion.motion = std::move(put->motion);
  motion.uncertainty.clear();
  return motion;
}

/// Returns a text with its sides exchanged; nullopt and an entry in `unknown` if that is
/// not possible.
std::optional<std::string> exchanged(const std::string& clip_id,
                                     const std::string& text,
                                     std::vector<UnknownSide>& unknown) {
  auto mirrored = library::exchanged_sides(text);
  if (!mirrored) unknown.push_back({clip_id, text});
  return mirrored;
}

}  // namespace

Result<ExportBody> open_export_body(const std::string& skeleton) {
  ExportBody out;
  if (skeleton == "own") return out;
  if (const auto named = library::named_skeleton(skeleton)) {
    out.skeleton = library::make_named_skeleton(*named);
    return out;
  }
  std::error_code problem;
  if (!std::filesystem::exists(skeleton, problem)) {
    return bad_input("--skeleton " + skeleton,
                     "is no skeleton of marey, and there is no such file",
                     "give own, marey, smpl22, lafan22, or the file of a body");
  }
  auto avatar = open_avatar(std::filesystem::path(skeleton));
  if (!avatar) return avatar.error();
  out.skeleton = avatar->skeleton;
  out.avatar = *std::move(avatar);
  return out;
}

ClipRecord mirrored_record(const ClipRecord& record, std::vector<UnknownSide>& unknown) {
  ClipRecord out = record;
  out.clip_id += "_mirror";
  out.mirror_of = record.clip_id;
  out.duplicate_of.clear();
  for (ClipFigure& figure : out.figures) {
    figure.joint = edit::mirrored_name(figure.joint);
  }
  for (ClipProblem& problem : out.problems) {
    problem.joint = edit::mirrored_name(problem.joint);
  }
  out.labels.clear();
  for (ClipLabel label : record.labels) {
    auto text = exchanged(record.clip_id, label.text, unknown);
    if (!text) continue;
    label.text = *std::move(text);
    out.labels.push_back(std::move(label));
  }
  std::ranges::stable_sort(out.labels, [](const ClipLabel& a, const ClipLabel& b) {
    return std::pair(a.start_s, a.text) < std::pair(b.start_s, b.text);
  });
  out.events.clear();
  for (const ClipEvent& event : record.events) {
    auto text = exchanged(record.clip_id, event.name, unknown);
    if (text) out.events.push_back({event.frame, *std::move(text)});
  }
  std::ranges::stable_sort(out.events, [](const ClipEvent& a, const ClipEvent& b) {
    return std::pair(a.frame, a.name) < std::pair(b.frame, b.name);
  });
  return out;
}

Result<std::vector<ExportedClip>> ClipConverter::convert(
    const ClipRecord& record,
    LibraryMotion motion,
    std::vector<UnknownSide>& unknown) const {
  if (body_.skeleton) {
    auto put = on_body(std::move(motion), body_);
    if (!put) return put.error();
    motion = *std::move(put);
  }
  ExportedClip clip{record, {}};
  if (options_.rate_hz && *options_.rate_hz != motion.motion.rate.hz) {
    LibraryMotion changed = at_rate(motion, *options_.rate_hz);
    if (changed.motion.poses.empty()) {
      return bad_input(record.clip_id,
                       "the clip is shorter than one frame of the new rate",
                       "export it at a higher rate");
    }
    renumber(clip.record, motion.motion, changed.motion);
    motion = std::move(changed);
  }
  if (options_.starts_at_origin) {
    const auto map = retarget::map_body(motion.motion.skeleton);
    if (!map) return map.error();
    library::start_at_origin(motion.motion, *map);
  }
  clip.motion = std::move(motion);
  std::vector<ExportedClip> out;
  out.push_back(std::move(clip));
  if (options_.adds_mirrored) {
    auto mirrored = mirrored_motion(out.front().motion);
    if (!mirrored) return mirrored.error();
    out.push_back({mirrored_record(out.front().record, unknown), *std::move(mirrored)});
  }
  return out;
}

}  // namespace marey::app
