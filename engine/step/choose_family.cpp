// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/step/choose_family.h"

#include <algorithm>
#include <utility>

#include "engine/models/ask_reach.h"
#include "engine/models/reach_family.h"
#include "engine/step/rehearsal.h"

namespace marey::engine {
namespace {

// Rates of members differ by at most this factor from 1.
constexpr double kMaxFamilyRate = 2.0;

Error family_error(const std::string& clip, std::string cause, std::string next) {
  return bad_input("action \"" + clip + "\"", std::move(cause), std::move(next));
}

}  // namespace

Result<std::vector<FamilyAction>> choose_family(const MotionBase& base,
                                                std::span<const std::string> clips,
                                                const std::string& arrive,
                                                int side,
                                                const glm::dvec3& target_in_heading_m,
                                                const Skeleton& skeleton,
                                                const retarget::BodyMap& map) {
  Rehearsal body(skeleton, map);
  const glm::dvec3 palm_in_t_pose =
      reach_lengths(skeleton, map, side).palm_m *
      map.limbs[static_cast<std::size_t>(side)]->along_in_t_pose;
  std::vector<FamilyMember> members;
  for (const std::string& name : clips) {
    const auto found = base.find(name);
    if (!found) {
      return family_error(name,
                          "the base has no clip of this name",
                          "see the clips with marey base list");
    }
    const MotionClip& clip = base.clip(*found);
    if (clip.loops) {
      return family_error(name, "the clip is a loop", "use clips that play once");
    }
    const auto event =
        std::find_if(clip.notes.begin(), clip.notes.end(), [&](const Annotation& n) {
          return n.text == arrive;
        });
    if (event == clip.notes.end()) {
      return family_error(name,
                          "the clip has no event \"" + arrive + "\"",
                          "add it with the operation event of marey edit");
    }
    body.sample(event->start_s, clip, base.layout());
    const RigidTransform wrist = posed_wrist(body.joints(), map, side);
    members.push_back({*found,
                       wrist.translation + wrist.rotation * palm_in_t_pose,
                       event->start_s,
                       clip.duration_s()});
  }
  const auto family = ReachFamily::make(members);
  if (!family) return family.error();
  const FamilyBlend blend = family->blend(target_in_heading_m, kMaxFamilyActions);
  std::vector<FamilyAction> out;
  for (std::size_t i = 0; i < blend.count; ++i) {
    const FamilyShare& share = blend.shares[i];
    if (i > 0 && share.weight < 1e-3) continue;
    const auto member =
        std::find_if(members.begin(), members.end(), [&](const FamilyMember& m) {
          return m.clip == share.clip;
        });
    out.push_back({share.clip,
                   share.weight,
                   std::clamp(share.rate, 1.0 / kMaxFamilyRate, kMaxFamilyRate),
                   member->arrive_s});
  }
  return out;
}

}  // namespace marey::engine
