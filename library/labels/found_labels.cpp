// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/labels/found_labels.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>

#include "library/quality/activity.h"
#include "library/quality/quality_frames.h"
#include "library/search/relations.h"
#include "library/segments/find_segments.h"
#include "library/segments/still_frames.h"

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/human/contacts.h"
#include "retarget/body/body_volume.h"
#include "retarget/hands/find_touches.h"

namespace marey::library {
namespace {

constexpr double kMinRun_s = 0.1;
constexpr double kMinIdle_s = 0.5;
constexpr double kFewLabels = 10.0;

const char* side_name(int side) {
  return side == 0 ? "left" : "right";
}

std::vector<char> marks_of(const std::vector<FootParts>& contacts,
                           std::initializer_list<std::size_t> parts) {
  std::vector<char> out(contacts.size(), 0);
  for (std::size_t t = 0; t < contacts.size(); ++t) {
    for (const std::size_t part : parts) {
      if (contacts[t][part] != 0) out[t] = 1;
    }
  }
  return out;
}

// Median height of a path in these frames; the height of the body's rest without any.
double resting_m(const std::vector<double>& heights_m,
                 const std::vector<FrameRange>& frames,
                 double otherwise_m) {
  std::vector<double> resting;
  for (const FrameRange& range : frames) {
    resting.insert(resting.end(),
                   heights_m.begin() + range.first,
                   heights_m.begin() + range.last + 1);
  }
  return resting.empty() ? otherwise_m : median(std::move(resting));
}

std::vector<double> heights_of(const std::vector<glm::dvec3>& path) {
  std::vector<double> out;
  out.reserve(path.size());
  for (const glm::dvec3& p : path) out.push_back(p.y);
  return out;
}

// The clip's own contacts, for find_relations().
Contacts contacts_of(const LibraryMotion& motion,
                     const retarget::BodyMap& map,
                     const QualityFrames& frames) {
  Contacts out;
  out.frame_count = frames.count;
  for (std::size_t side = 0; side < 2; ++side) {
    FootContacts& foot = out.feet[side];
    const std::size_t heel = 2 * side;
    foot.heel = runs_of(marks_of(motion.contacts, {heel}), frames.hz, 0.0);
    foot.ball = runs_of(marks_of(motion.contacts, {heel + 1}), frames.hz, 0.0);
    foot.stance = runs_of(marks_of(motion.contacts, {heel, heel + 1}), frames.hz, 0.0);
    const auto ankle = heights_of(frames[foot_of(static_cast<int>(side))].p_in_world);
    foot.ankle_height_m = resting_m(ankle, foot.heel, map.feet[side].ankle_height_m);
    foot.ball_height_m = resting_m(
        heights_of(frames.ball_in_world[side]), foot.ball, map.feet[side].ball_height_m);
  }
  return out;
}

/// Collects labels and events of one clip.
class LabelCollector {
 public:
  LabelCollector(int count, double hz) : last_(count - 1), hz_(hz) {}

  void add(const FrameRange& frames, std::string text) {
    if (frames.last - frames.first < kMinRun_s * hz_ - 1e-9) return;
    out_.labels.push_back(
        {frames.first / hz_, frames.last / hz_, std::move(text), "marey", 1.0});
  }
  void add_event(int frame, std::string name) {
    out_.events.push_back({frame, std::move(name)});
  }
  // The ends of a run as events, unless they are ends of the clip.
  void add_ends(const FrameRange& frames,
                const std::string& begin,
                const std::string& end) {
    if (frames.first > 0) add_event(frames.first, begin);
    if (frames.last < last_) add_event(frames.last, end);
  }

  FoundLabels take() {
    keep_longest();
    std::sort(out_.labels.begin(), out_.labels.end(), [](const auto& a, const auto& b) {
      return std::tie(a.start_s, a.text, a.end_s) < std::tie(b.start_s, b.text, b.end_s);
    });
    std::sort(out_.events.begin(), out_.events.end(), [](const auto& a, const auto& b) {
      return std::tie(a.frame, a.name) < std::tie(b.frame, b.name);
    });
    return std::move(out_);
  }

 private:
  void keep_longest() {
    const auto most = static_cast<std::size_t>(kFewLabels + last_ / hz_);
    std::stable_sort(
        out_.labels.begin(), out_.labels.end(), [](const auto& a, const auto& b) {
          return std::make_tuple(
                     std::string_view(a.text), a.start_s - a.end_s, a.start_s) <
                 std::make_tuple(
                     std::string_view(b.text), b.start_s - b.end_s, b.start_s);
        });
    std::vector<ClipLabel> kept;
    std::size_t count = 0;
    for (ClipLabel& label : out_.labels) {
      count = kept.empty() || kept.back().text != label.text ? 0 : count + 1;
      if (count < most) kept.push_back(std::move(label));
    }
    out_.labels = std::move(kept);
  }

  int last_ = 0;
  double hz_ = 0.0;
  FoundLabels out_;
};

void add_relations(const std::vector<RelationRun>& runs,
                   double hz,
                   int last,
                   LabelCollector& out) {
  for (const RelationRun& run : runs) {
    out.add(run.frames, std::string(name(run.relation)));
    const bool is_whole = run.frames.first > 0 && run.frames.last < last;
    if (run.relation == Relation::kFlight && is_whole &&
        run.frames.last - run.frames.first >= kMinRun_s * hz - 1e-9) {
      out.add_ends(run.frames, "take_off", "landing");
    }
  }
}

void add_touches(const Motion& motion,
                 const retarget::BodyMap& map,
                 LabelCollector& out) {
  if (!map.limbs[0] && !map.limbs[1]) return;
  const retarget::BodyVolume volume = retarget::average_volume(motion.skeleton, map);
  for (const retarget::Touch& touch :
       retarget::find_touches(motion, map, volume).touches) {
    const std::string side = side_name(touch.side);
    out.add(touch.frames, "hand_" + side + " touches " + std::string(name(touch.part)));
    out.add_ends(touch.frames, side + ".touch", side + ".release");
  }
}

}  // namespace

FoundLabels find_labels(const LibraryMotion& motion, const retarget::BodyMap& map) {
  MAREY_ASSERT(motion.contacts.size() == motion.motion.poses.size());
  if (motion.motion.poses.empty()) return {};
  const QualityFrames frames = quality_frames(motion.motion, map);
  const Contacts contacts = contacts_of(motion, map, frames);
  LabelCollector out(frames.count, frames.hz);
  add_relations(
      find_relations(motion.motion, map, contacts), frames.hz, frames.count - 1, out);
  add_touches(motion.motion, map, out);
  for (const FrameRange& run : runs_of(still_frames(frames), frames.hz, kMinIdle_s)) {
    out.add(run, "still");
  }
  for (const FrameRange& run :
       runs_of(t_pose_frames(frames, map), frames.hz, kMinIdle_s)) {
    out.add(run, "tpose");
  }
  for (const FrameRange& cycle : find_cycles(motion.contacts, frames.hz)) {
    out.add(cycle, "cycle");
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const std::string foot = side_name(static_cast<int>(side));
    for (const FrameRange& stance : contacts.feet[side].stance) {
      out.add_ends(stance, foot + ".strike", foot + ".toe_off");
    }
  }
  return out.take();
}

}  // namespace marey::library
