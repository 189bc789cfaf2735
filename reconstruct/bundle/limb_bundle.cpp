// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/limb_bundle.h"

#include <algorithm>
#include <utility>

namespace marey::reconstruct {
namespace {

bool belongs_to(const HumanLimb& limb, HumanBone bone) {
  return bone == limb.upper || bone == limb.lower || bone == limb.end;
}

}  // namespace

void cut_out(std::size_t limb, const SubjectBundle& whole, LimbBundle& out) {
  const HumanLimb& bones = human_limbs()[limb];
  out.bundle = whole;
  out.bundle.frames.clear();
  for (std::size_t f = 0; f < whole.frames.size(); ++f) {
    std::vector<TagSighting> own;
    for (const TagSighting& s : whole.frames[f].sightings) {
      if (belongs_to(bones, whole.model.bone(s.tag))) own.push_back(s);
    }
    if (own.empty()) continue;
    out.frames.push_back(f);
    out.sightings.push_back(std::move(own));
    out.bundle.frames.push_back(whole.frames[f]);
  }
  for (std::size_t i = 0; i < out.sightings.size(); ++i) {
    out.bundle.frames[i].sightings = out.sightings[i];
  }
}

void take_back(std::size_t limb, const LimbBundle& from, SubjectBundle& whole) {
  const LimbParameters& s = kLimbParameters[limb];
  whole.model.lengths = from.bundle.model.lengths;
  whole.model.body = from.bundle.model.body;
  whole.model.segment_from_tag = from.bundle.model.segment_from_tag;
  for (std::size_t i = 0; i < from.frames.size(); ++i) {
    Posture& posture = whole.frames[from.frames[i]].posture;
    for (const PoseParameter parameter :
         {s.frame, s.flexion, s.upper_twist, s.lower_twist, s.extremity}) {
      const double* now = from.bundle.frames[i].posture.block(parameter);
      std::copy_n(now, block_size(parameter), posture.block(parameter));
    }
  }
}

}  // namespace marey::reconstruct
