// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/foot_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "dynamics/flight/find_flights.h"

#include "core/base/frame_range.h"
#include "core/humanoid.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::app {
namespace {

// Feet are slow just before they leave the floor and just after they meet it, but slower
// in the middle of a contact. Contacts by speed and height are too short by this at each
// end.
constexpr double kEdge_s = 0.12;
// Feet that leave the floor together do so within this time.
constexpr double kTogether_s = 0.06;

/// The frames of one joint of NpzContacts.
class JointFrames {
 public:
  JointFrames(recordings::NpzContacts& contacts, std::size_t joint)
      : bears_(&contacts.bears), joints_(contacts.names.size()), joint_(joint) {}

  [[nodiscard]] bool at(int frame) const { return (*bears_)[place(frame)] != 0; }
  void set(int first, int last, bool bears) {
    for (int frame = first; frame <= last; ++frame) {
      (*bears_)[place(frame)] = bears ? 1 : 0;
    }
  }
  [[nodiscard]] int frames() const { return static_cast<int>(bears_->size() / joints_); }

  /// Returns the last frame with contact in [first, last]; `first` - 1 if there is none.
  [[nodiscard]] int last_in(int first, int last) const {
    int frame = last;
    while (frame >= first && !at(frame)) --frame;
    return frame;
  }
  /// Returns the first frame with contact; `last` + 1 if there is none.
  [[nodiscard]] int first_in(int first, int last) const {
    int frame = first;
    while (frame <= last && !at(frame)) ++frame;
    return frame;
  }

 private:
  [[nodiscard]] std::size_t place(int frame) const {
    return static_cast<std::size_t>(frame) * joints_ + joint_;
  }

  std::decay_t<decltype(recordings::NpzContacts::bears)>* bears_;
  std::size_t joints_;
  std::size_t joint_;
};

/// Returns true if the skeleton was made by make_humanoid().
bool is_own_skeleton(const Skeleton& skeleton) {
  if (skeleton.joints.size() != kHumanBoneCount) return false;
  for (const HumanBone bone : human_bones()) {
    if (skeleton.joints[index(bone)].bone != bone) return false;
  }
  return true;
}

/// Removes contacts during a flight. Feet in contact just before the flight bear until it
/// begins, and feet in contact just after it bear from its end on.
void agree_with_flight(const dynamics::Flight& flight,
                       double rate_hz,
                       recordings::NpzContacts& contacts) {
  std::vector<JointFrames> joints;
  for (std::size_t j = 0; j < contacts.names.size(); ++j)
    joints.emplace_back(contacts, j);
  const int frames = joints[0].frames();
  const int takeoff =
      std::clamp(static_cast<int>(std::floor(flight.takeoff_s * rate_hz)), 0, frames - 1);
  const int landing =
      std::clamp(static_cast<int>(std::ceil(flight.landing_s * rate_hz)), 0, frames - 1);
  if (landing <= takeoff) return;
  for (JointFrames& joint : joints) joint.set(takeoff + 1, landing - 1, false);
  const int reach = static_cast<int>(std::lround(kEdge_s * rate_hz));
  const int together = static_cast<int>(std::lround(kTogether_s * rate_hz));
  const int from = std::max(0, takeoff - reach);
  const int until = std::min(frames - 1, landing + reach);
  std::vector<int> last;
  std::vector<int> first;
  for (const JointFrames& joint : joints) {
    last.push_back(joint.last_in(from, takeoff));
    first.push_back(joint.first_in(landing, until));
  }
  const int latest = *std::max_element(last.begin(), last.end());
  const int earliest = *std::min_element(first.begin(), first.end());
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const std::size_t heel = 2 * foot;
    const std::size_t leaving = last[heel] > last[heel + 1] ? heel : heel + 1;
    if (last[leaving] >= from && last[leaving] >= latest - together) {
      joints[leaving].set(last[leaving], takeoff, true);
    }
    const std::size_t meeting = first[heel] < first[heel + 1] ? heel : heel + 1;
    if (first[meeting] <= until && first[meeting] <= earliest + together) {
      joints[meeting].set(landing, first[meeting], true);
    }
  }
}

}  // namespace

recordings::NpzContacts foot_contacts(const Motion& motion) {
  recordings::NpzContacts out;
  const auto map = retarget::map_body(motion.skeleton);
  if (!map || motion.poses.empty()) return out;
  const Contacts contacts = retarget::detect_contacts(motion, *map);
  for (const HumanBone bone : {HumanBone::kLeftFoot,
                               HumanBone::kLeftToes,
                               HumanBone::kRightFoot,
                               HumanBone::kRightToes}) {
    out.names.emplace_back(name(bone));
  }
  out.bears.assign(out.names.size() * motion.poses.size(), 0);
  const auto mark = [&](const std::vector<FrameRange>& intervals, std::size_t place) {
    for (const auto& [first, last] : intervals) {
      for (int frame = first; frame <= last; ++frame) {
        out.bears[static_cast<std::size_t>(frame) * out.names.size() + place] = 1;
      }
    }
  };
  for (std::size_t side = 0; side < 2; ++side) {
    mark(contacts.feet[side].heel, 2 * side);
    mark(contacts.feet[side].ball, 2 * side + 1);
  }
  if (is_own_skeleton(motion.skeleton)) {
    for (const dynamics::Flight& flight : dynamics::find_flights(motion)) {
      agree_with_flight(flight, motion.rate.hz, out);
    }
  }
  return out;
}

}  // namespace marey::app
