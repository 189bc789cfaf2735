// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/subject_wizard.h"

#include <algorithm>
#include <array>
#include <utility>

#include <glm/geometric.hpp>

#include "app/live_chain/assess_live_subject.h"
#include "core/base/assert.h"

namespace marey::app {
namespace {

using live::WizardAction;
using live::WizardCamera;
using live::WizardStep;

/// Share of the parts with tags that must be visible while the subject stands.
constexpr double kMinPartsShare = 0.6;
/// Limit of the median shift of the tags, as a share of the picture's width. It is above
/// the sway of a standing body: about 5 cm at 3 m.
constexpr double kStillShare = 0.015;
constexpr std::size_t kMinShifts = 4;
/// Maximum time that counts between two instants.
constexpr double kMaxWizardStep_s = 0.2;
/// A part counts as seen after this number of instants with two sightings.
constexpr int kPairs = 10;
// Minimum durations, for an early "next" and for recordings that end.
constexpr double kMinStand_s = 0.5;
constexpr double kMinMove_s = 5.0;
/// Number of sightings at which a cell of the picture counts as full.
constexpr double kFullCell = 30.0;

/// Instructions of the moving step, in order.
constexpr std::array kMoves{
    "Turn around slowly, all the way.",
    "Swing the arms: forward, to the sides, over the head.",
    "Bend and stretch the elbows; turn the palms up and down.",
    "Squat; lift each knee; swing each leg forward and to the side.",
    "Bend and twist the trunk; nod and turn the head.",
    "Bend wrists and ankles; shift the weight from foot to foot.",
};

glm::dvec2 centre_of(const TagDetection& tag) {
  return 0.25 *
         (tag.corners_px[0] + tag.corners_px[1] + tag.corners_px[2] + tag.corners_px[3]);
}

std::size_t cell_of(const glm::dvec2& p_px, const Intrinsics& picture) {
  const auto part = [](double at, int size, std::size_t cells) {
    const double share = at / std::max(size, 1);
    const auto cell = static_cast<int>(share * static_cast<double>(cells));
    return static_cast<std::size_t>(std::clamp(cell, 0, static_cast<int>(cells) - 1));
  };
  return part(p_px.y, picture.height_px, WizardCamera::kRows) * WizardCamera::kColumns +
         part(p_px.x, picture.width_px, WizardCamera::kColumns);
}

}  // namespace

SubjectWizard::SubjectWizard(WizardSetup setup, const WizardOptions& options)
    : setup_(std::move(setup)), options_(options) {
  MAREY_ASSERT(setup_.cameras.size() == setup_.rms_px.size());
  MAREY_ASSERT(!setup_.prior.tags.empty());
  for (const TagOnSegment& tag : setup_.prior.tags) parts_.insert(tag.segment);
  ui_state_.title = "Measure a subject";
  ui_state_.text =
      "Measures the lengths of the limbs and the positions of the tags: stand still, "
      "then move every joint.";
}

std::optional<std::string> SubjectWizard::act(WizardAction action) {
  const WizardStep now = step();
  const bool is_busy =
      now == WizardStep::kStand || now == WizardStep::kMove || now == WizardStep::kSolve;
  switch (action) {
    case WizardAction::kStart:
      if (is_busy) return "a subject is already being measured";
      start();
      return std::nullopt;
    case WizardAction::kCancel:
      ui_state_ = SubjectWizard(setup_, options_).ui_state();
      material_ = {};
      has_material_ = false;
      return std::nullopt;
    case WizardAction::kNext:
      if (now == WizardStep::kStand && counted_s_ >= kMinStand_s) {
        begin_move();
        return std::nullopt;
      }
      if (now == WizardStep::kMove && counted_s_ >= kMinMove_s) {
        begin_solve();
        return std::nullopt;
      }
      return now == WizardStep::kStand  ? "no subject has stood still yet"
             : now == WizardStep::kMove ? "move for at least five seconds"
                                        : "no step is active";
    case WizardAction::kAccept:
      if (now != WizardStep::kDone) return "there is nothing to accept";
      ui_state_.step = WizardStep::kIdle;
      ui_state_.title = "Measured";
      ui_state_.text = "The run continues with this body. Start measures again.";
      ui_state_.error.clear();
      return std::nullopt;
  }
  return std::nullopt;
}

void SubjectWizard::start() {
  ui_state_ = {};
  ui_state_.step = WizardStep::kStand;
  ui_state_.title = "Stand still";
  ui_state_.text = "Stand upright where all cameras see you, arms a little off the body.";
  for (std::size_t c = 0; c < setup_.cameras.size(); ++c) {
    ui_state_.cameras.push_back({setup_.cameras[c].name, {}, setup_.rms_px[c]});
  }
  const std::size_t tags = setup_.prior.tags.size();
  material_ = {nothing_seen(), nothing_seen()};
  has_material_ = false;
  counted_s_ = 0.0;
  last_.reset();
  was_restless_ = false;
  const std::size_t cells = WizardCamera::kColumns * WizardCamera::kRows;
  cells_.assign(setup_.cameras.size(), std::vector<int>(cells, 0));
  now_.assign(tags, 0);
  twice_.assign(tags, 0);
  stood_px_.assign(setup_.cameras.size(), {});
  for (auto& places : stood_px_) places.assign(tags, std::nullopt);
}

void SubjectWizard::begin_move() {
  ui_state_.step = WizardStep::kMove;
  ui_state_.title = "Move every joint";
  ui_state_.text = kMoves.front();
  ui_state_.progress = 0.0;
  counted_s_ = 0.0;
  last_.reset();
}

void SubjectWizard::begin_solve() {
  ui_state_.step = WizardStep::kSolve;
  ui_state_.title = "Wait";
  ui_state_.text = "The body is computed from the recorded tags. This can take a minute.";
  ui_state_.progress = 0.0;
  has_material_ = true;
}

void SubjectWizard::fail(const std::string& why) {
  ui_state_.step = WizardStep::kFailed;
  ui_state_.title = "The measurement failed";
  ui_state_.text = "Follow the steps of the message, then start again.";
  ui_state_.error = why;
  material_ = {};
  has_material_ = false;
}

void SubjectWizard::process(const LiveInstant& instant) {
  if (step() != WizardStep::kStand && step() != WizardStep::kMove) return;
  update_visible_tags(instant);
  if (step() == WizardStep::kStand) {
    add_standing(instant);
  } else {
    move(instant);
  }
}

void SubjectWizard::end() {
  if (step() == WizardStep::kMove && counted_s_ >= kMinMove_s) return begin_solve();
  if (step() == WizardStep::kStand) {
    fail(
        "no subject was seen standing still for long enough. Next: check that the "
        "cameras see the tags, and stand still for some seconds.");
  } else if (step() == WizardStep::kMove) {
    fail("the run ended before every joint had moved. Next: move for " +
         std::to_string(static_cast<int>(options_.move_s)) + " seconds.");
  }
}

/// Updates the visible tags and their positions in the pictures.
void SubjectWizard::update_visible_tags(const LiveInstant& instant) {
  std::fill(now_.begin(), now_.end(), 0);
  for (const CameraTags& view : instant.views) {
    const std::size_t c = index(view.camera);
    MAREY_ASSERT(c < setup_.cameras.size());
    for (const TagDetection& seen : view.tags) {
      const auto& tags = setup_.prior.tags;
      const auto found = std::find_if(
          tags.begin(), tags.end(), [&](const auto& tag) { return tag.id == seen.id; });
      if (found == tags.end()) continue;
      ++now_[static_cast<std::size_t>(found - tags.begin())];
      const std::size_t cell = cell_of(centre_of(seen), setup_.cameras[c].intrinsics);
      const int count = ++cells_[c][cell];
      ui_state_.cameras[c].grid[cell] = std::min(count / kFullCell, 1.0);
    }
  }
}

void SubjectWizard::add_standing(const LiveInstant& instant) {
  const std::set<HumanBone> there = parts_of(now_, 1);
  const bool is_enough = there.contains(HumanBone::kHips) &&
                         static_cast<double>(there.size()) >=
                             kMinPartsShare * static_cast<double>(parts_.size());
  if (!is_enough) {
    last_.reset();
    ui_state_.text = "The cameras see too little of the body. " + missing_parts(there);
    return;
  }
  if (has_moved(instant)) {
    material_.standing = nothing_seen();
    counted_s_ = 0.0;
    was_restless_ = true;
    last_.reset();
  }
  count_time(instant.time);
  keep(instant, material_.standing);
  if (counted_s_ >= kMinStand_s) was_restless_ = false;
  ui_state_.text = was_restless_ ? "Stand still: you moved, so the step starts again."
                                 : "Stay like this for a moment.";
  ui_state_.progress = std::min(counted_s_ / options_.stand_s, 1.0);
  if (counted_s_ >= options_.stand_s) begin_move();
}

void SubjectWizard::move(const LiveInstant& instant) {
  if (!parts_of(now_, 1).contains(HumanBone::kHips)) {
    last_.reset();
    ui_state_.text = "No camera sees a tag of the hips: stay in the middle.";
    return;
  }
  count_time(instant.time);
  keep(instant, material_.moving);
  for (std::size_t t = 0; t < now_.size(); ++t) {
    if (sightings_of(setup_.prior.tags[t].segment) >= 2) ++twice_[t];
  }
  const std::set<HumanBone> seen = parts_of(twice_, kPairs);
  const double time_share = std::min(counted_s_ / options_.move_s, 1.0);
  const double part_share =
      static_cast<double>(seen.size()) / static_cast<double>(parts_.size());
  ui_state_.progress = 0.5 * (time_share + part_share * time_share);
  if (counted_s_ < options_.move_s) {
    const auto which =
        static_cast<std::size_t>(time_share * static_cast<double>(kMoves.size()));
    ui_state_.text = kMoves[std::min(which, kMoves.size() - 1)];
  } else {
    ui_state_.text = "Turn so that the cameras see more of you. " + missing_parts(seen);
  }
  const bool is_over = counted_s_ >= 2.0 * options_.move_s;
  if (is_over || (counted_s_ >= options_.move_s && seen.size() == parts_.size())) {
    begin_solve();
  }
}

void SubjectWizard::count_time(Timestamp time) {
  if (last_) counted_s_ += std::clamp(seconds(time - *last_), 0.0, kMaxWizardStep_s);
  last_ = time;
}

/// Returns true if the tags have moved since the standing began, and then stores their
/// new positions.
bool SubjectWizard::has_moved(const LiveInstant& instant) {
  shifts_.clear();
  const auto compare = [&](bool replace) {
    for (const CameraTags& view : instant.views) {
      const std::size_t c = index(view.camera);
      for (const TagDetection& seen : view.tags) {
        for (std::size_t t = 0; t < setup_.prior.tags.size(); ++t) {
          if (setup_.prior.tags[t].id != seen.id) continue;
          std::optional<glm::dvec2>& stood_px = stood_px_[c][t];
          if (stood_px && !replace) {
            shifts_.push_back(glm::distance(*stood_px, centre_of(seen)) /
                              setup_.cameras[c].intrinsics.width_px);
          }
          if (!stood_px || replace) stood_px = centre_of(seen);
        }
      }
    }
  };
  compare(false);
  if (shifts_.size() < kMinShifts) return false;
  const auto middle = shifts_.begin() + static_cast<std::ptrdiff_t>(shifts_.size() / 2);
  std::nth_element(shifts_.begin(), middle, shifts_.end());
  if (*middle <= kStillShare) return false;
  for (auto& places : stood_px_) std::fill(places.begin(), places.end(), std::nullopt);
  compare(true);
  return true;
}

void SubjectWizard::keep(const LiveInstant& instant,
                         std::vector<CameraDetections>& out) const {
  for (CameraDetections& camera : out) {
    camera.frames.push_back({static_cast<int>(camera.frames.size()), {}, {}});
  }
  for (const CameraTags& view : instant.views) {
    const TagShrinkage& shrinkage = setup_.cameras[index(view.camera)].tag_shrinkage;
    auto& tags = out[index(view.camera)].frames.back().tags;
    tags = view.tags;
    for (TagDetection& tag : tags) tag.corners_px = unshrunk(tag.corners_px, shrinkage);
  }
}

/// Returns the number of sightings of a part in this instant, over its tags and all
/// cameras.
int SubjectWizard::sightings_of(HumanBone part) const {
  int sightings = 0;
  for (std::size_t t = 0; t < now_.size(); ++t) {
    if (setup_.prior.tags[t].segment == part) sightings += now_[t];
  }
  return sightings;
}

/// Returns the parts with a tag whose count is at least `min_count`.
std::set<HumanBone> SubjectWizard::parts_of(const std::vector<int>& counts,
                                            int min_count) const {
  std::set<HumanBone> parts;
  for (std::size_t t = 0; t < counts.size(); ++t) {
    if (counts[t] >= min_count) parts.insert(setup_.prior.tags[t].segment);
  }
  return parts;
}

std::string SubjectWizard::missing_parts(const std::set<HumanBone>& there) const {
  constexpr int kMax = 3;
  std::string names;
  int missing = 0;
  for (const HumanBone part : parts_) {
    if (there.contains(part)) continue;
    if (++missing <= kMax) names += (names.empty() ? "" : ", ") + in_words(part);
  }
  if (missing > kMax) names += " and others";
  return names.empty() ? "" : "Missing: " + names + ".";
}

std::vector<CameraDetections> SubjectWizard::nothing_seen() const {
  std::vector<CameraDetections> out(setup_.cameras.size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c].source = setup_.cameras[c].name;
    out[c].camera = CameraId{static_cast<int>(c)};
    out[c].width_px = setup_.cameras[c].intrinsics.width_px;
    out[c].height_px = setup_.cameras[c].intrinsics.height_px;
    out[c].rate = setup_.rate;
  }
  return out;
}

std::optional<WizardMaterial> SubjectWizard::take_material() {
  if (!has_material_) return std::nullopt;
  has_material_ = false;
  return std::exchange(material_, {});
}

void SubjectWizard::finish(const Result<reconstruct::SubjectFit>& fit) {
  if (step() != WizardStep::kSolve) return;
  if (!fit) return fail(fit.error().message());
  ui_state_.step = WizardStep::kDone;
  ui_state_.title = "The body is measured";
  ui_state_.quality = assess_live_subject(*fit);
  ui_state_.text = is_good() ? "Accept stores it, and the run continues with it."
                             : "Some values are poor: cancel and start again.";
}

void SubjectWizard::refuse_acceptance(const std::string& why) {
  MAREY_ASSERT(step() == WizardStep::kIdle && !ui_state_.quality.empty());
  ui_state_.step = WizardStep::kDone;
  ui_state_.title = "The body is measured, but could not be stored";
  ui_state_.error = why;
}

bool SubjectWizard::is_good() const {
  return step() == WizardStep::kDone &&
         std::all_of(ui_state_.quality.begin(),
                     ui_state_.quality.end(),
                     [](const auto& one) { return one.severity == Severity::kNote; });
}

}  // namespace marey::app
