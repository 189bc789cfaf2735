// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/view/view_handles.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "app/motion/foot_contacts.h"
#include "app/view/constraint_kind.h"
#include "recordings/body/constraints_file.h"
#include "retarget/adapt/adapter.h"
#include "retarget/character/make_character.h"
#include "retarget/constraints/check_constraints.h"
#include "retarget/constraints/measure_constraint.h"

namespace marey::app {
namespace {

bool has_supports(const ConstraintSet& set) {
  return std::ranges::any_of(set.constraints, [](const Constraint& constraint) {
    return std::holds_alternative<Support>(constraint.goal);
  });
}

std::optional<Character> character_of(const ViewedFigure& figure) {
  const auto map = retarget::map_body(figure.motion.skeleton);
  if (!map) return std::nullopt;
  auto character = retarget::make_character(figure.name, figure.motion.skeleton, *map);
  if (!character) return std::nullopt;
  return *std::move(character);
}

/// Detects the frames in which the ankle or toe joint of a foot is in contact.
std::array<std::vector<bool>, 2> bearing(const Motion& motion) {
  std::array<std::vector<bool>, 2> out;
  const recordings::NpzContacts contacts = foot_contacts(motion);
  const std::size_t places = contacts.names.size();
  for (std::size_t place = 0; place < places; ++place) {
    const std::size_t side = contacts.names[place].starts_with("left") ? 0 : 1;
    out[side].resize(motion.poses.size(), false);
    for (std::size_t i = 0; i < motion.poses.size(); ++i) {
      if (contacts.bears[i * places + place] != 0) out[side][i] = true;
    }
  }
  return out;
}

Error refused(std::string cause) {
  return bad_input("what is dragged", std::move(cause), "reload the page");
}

}  // namespace

Result<ViewHandles> ViewHandles::make(const ViewedRecording& recording,
                                      const std::filesystem::path& constraints) {
  ViewHandles out;
  for (std::size_t f = 0; f < recording.figures.size(); ++f) {
    auto character = character_of(recording.figures[f]);
    if (!character) continue;
    out.figure_ = f;
    out.motion_ = recording.figures[f].motion;
    out.character_ = *std::move(character);
    out.handles_ = body_handles(out.motion_.skeleton);
    out.bears_ = bearing(out.motion_);
    break;
  }
  if (constraints.empty()) return out;
  if (out.handles_.empty()) {
    return bad_input(constraints.string(),
                     "constraints need a human body, and none is shown",
                     "give the motion of a human body, or leave --constraints out");
  }
  auto file = recordings::read_constraints(constraints);
  if (!file) return file.error();
  out.of_file_ = std::move(file->set);
  if (const Status ok = retarget::check_constraints(out.of_file_, out.character_); !ok) {
    Error error = ok.error();
    error.where = constraints.string() + ": " + error.where;
    return error;
  }
  // Names are unique: constraints of the file replace handles of the same name.
  std::erase_if(out.handles_, [&out](const BodyHandle& handle) {
    return out.of_file_.find(handle.id) != nullptr;
  });
  return out;
}

std::vector<live::PageConstraint> ViewHandles::constraints() const {
  std::vector<live::PageConstraint> out;
  for (const Constraint& constraint : of_file_.constraints) {
    live::PageConstraint& shown = out.emplace_back();
    shown.id = constraint.id;
    shown.skeleton = figure_;
    shown.kind = page_kind(constraint);
    shown.draggable = is_draggable_place(constraint);
    const auto wanted = target_in_world(constraint.goal);
    shown.p_in_world = wanted.value_or(glm::dvec3(0.0));
    if (!wanted)
      shown.joint = retarget::carried_point(character_, constraint.point).joint;
  }
  for (const BodyHandle& handle : handles_) {
    live::PageConstraint& shown = out.emplace_back();
    shown.id = handle.id;
    shown.skeleton = figure_;
    shown.active = false;
    shown.draggable = true;
    shown.joint = handle.joint;
  }
  return out;
}

bool ViewHandles::is_draggable(const std::string& id) const {
  const Constraint* of_file = of_file_.find(id);
  if (of_file != nullptr) return is_draggable_place(*of_file);
  return std::ranges::find(handles_, id, &BodyHandle::id) != handles_.end();
}

Status ViewHandles::drag(live::ClientId client, const live::DragRequest& drag) {
  constexpr std::size_t kMaxPages = 16;
  if (!is_draggable(drag.id)) return refused("there is no handle \"" + drag.id + "\"");
  const int frame = drag.frame.value_or(-1) - motion_.first_frame;
  if (!drag.frame || frame < 0 || frame >= static_cast<int>(motion_.poses.size())) {
    return refused("this frame has no figure");
  }
  const auto known = std::ranges::find(pages_, client, &Page::client);
  if (known == pages_.end()) {
    if (pages_.size() >= kMaxPages) pages_.erase(pages_.begin());
    pages_.push_back({client, frame, {}});
  } else {
    std::rotate(known, known + 1, pages_.end());
  }
  Page& page = pages_.back();
  if (page.frame != frame) page.held.clear();
  page.frame = frame;
  const auto held = std::ranges::find(page.held, drag.id, &Held::id);
  if (held == page.held.end()) {
    page.held.push_back({drag.id, drag.p_in_world});
  } else {
    held->p_in_world = drag.p_in_world;
  }
  return Done{};
}

bool ViewHandles::release(live::ClientId client, const std::string& id) {
  const auto page = std::ranges::find(pages_, client, &Page::client);
  return page != pages_.end() &&
         std::erase_if(page->held, [&id](const Held& held) { return held.id == id; }) > 0;
}

/// Returns the constraints of the page's frame. Dragged handles have full weight, without
/// a fade.
ConstraintSet ViewHandles::constraints_of(const Page& page) const {
  ConstraintSet set = of_file_;
  std::vector<std::string> dragged;  // Segments.
  for (const Held& held : page.held) {
    Constraint* constraint = set.find(held.id);
    if (constraint == nullptr) {
      const auto handle = std::ranges::find(handles_, held.id, &BodyHandle::id);
      constraint = &set.constraints.emplace_back(handle_constraint(*handle, 0.0));
    }
    std::get<DistanceToPoint>(constraint->goal).p_in_world = held.p_in_world;
    constraint->activation = {};
    dragged.push_back(constraint->point.segment);
  }
  if (has_supports(of_file_)) return set;
  const auto i = static_cast<std::size_t>(page.frame);
  for (Constraint& support : foot_supports(motion_.skeleton, 0.0)) {
    const std::vector<bool>& bears = bears_[support.point.segment == "leftFoot" ? 0 : 1];
    const bool stands = i < bears.size() && bears[i];
    const bool is_dragged =
        std::ranges::find(dragged, support.point.segment) != dragged.end();
    if (!stands || is_dragged) continue;
    support.activation = {};
    set.constraints.push_back(std::move(support));
  }
  return set;
}

std::optional<Result<ViewHandles::Adapted>> ViewHandles::adapted(
    live::ClientId client) const {
  const auto page = std::ranges::find(pages_, client, &Page::client);
  if (page == pages_.end()) return std::nullopt;
  auto adapter = retarget::Adapter::make(character_, constraints_of(*page), {});
  if (!adapter) return adapter.error();
  Adapted out{page->frame, {}};
  const double time_s = (motion_.first_frame + page->frame) / motion_.rate.hz;
  (void)adapter->adapt(
      motion_.poses[static_cast<std::size_t>(page->frame)], time_s, out.pose);
  return out;
}

}  // namespace marey::app
