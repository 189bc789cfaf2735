// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_script.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/engine/scene_order.h"
#include "recordings/base/number_text.h"
#include "recordings/edit/edit_value_keys.h"
#include "recordings/scene/read_bodies.h"
#include "recordings/scene/read_deed.h"
#include "recordings/scene/scene_limits.h"
#include "recordings/scene/scene_values.h"

namespace marey::recordings::stage {
namespace {

bool is_within(const SceneMembers& some, const SceneMembers& all) {
  return all.first <= some.first && some.first + some.count <= all.first + all.count;
}

void read_priorities(TomlReader& in, SceneAction& action) {
  read_number(in, "priority", action.priority, kPriority);
  if (!in.has("priorities")) return;
  TomlReader table = in.table("priorities");
  std::vector<std::string_view> words;
  for (const EditGroup group : kEditGroups) words.push_back(name(group));
  table.allow(words);
  for (std::size_t g = 0; g < words.size(); ++g) {
    read_number(table, words[g], action.group_priority[g], kPriority);
  }
}

SceneAction read_action(TomlReader& in,
                        const Scene& scene,
                        std::vector<std::string>& ids) {
  SceneAction action;
  action.line = in.line();
  const std::size_t deed = read_choice_of(in, "do", kSceneDeeds);
  if (!in.ok()) return action;
  std::vector<std::string_view> keys{"do", "id", "body", "time_s", "after", "event"};
  const bool is_stop = kSceneDeeds[deed] == "stop";
  if (!is_stop) {
    for (const std::string_view key : {"for_s", "priority", "priorities", "fade_in_s"}) {
      keys.push_back(key);
    }
  }
  keys.insert(keys.end(), {"layer", "fade_out_s"});
  keys.insert(keys.end(), deed_keys(deed).begin(), deed_keys(deed).end());
  in.allow(keys);
  if (in.has("id")) {
    action.id = read_id(in, "id", ids);
    ids.push_back(action.id);
  }
  (void)read_members(in, "body", scene, action.body);
  read_text(in, "after", action.after, kMaxIdBytes);
  read_text(in, "event", action.event, kMaxNameBytes);
  if (in.has("event") && !in.has("after")) {
    in.fail("event", "\"event\" is given without \"after\"", "add after, an action's id");
  }
  action.time_s = in.has("after") && !in.has("time_s") ? 0.0 : in.number("time_s", kTime);
  if (action.time_s > scene.duration_s) {
    in.fail("time_s", "the action starts after the scene's end", "increase duration_s");
  }
  read_number(in, "for_s", action.for_s, kActionDuration);
  if (in.has("layer") && !is_stop) action.layer = in.integer("layer", kLayer);
  read_priorities(in, action);
  read_number(in, "fade_in_s", action.fade_in_s, kFade);
  read_number(in, "fade_out_s", action.fade_out_s, kFade);
  if (in.ok()) action.deed = read_deed(in, deed, scene);
  check_target_pairs(in, "body", scene, action.body, target_of(action));
  return action;
}

/// Checks the references of actions to each other.
class ActionCheck {
 public:
  ActionCheck(const Scene& scene, std::vector<TomlReader>& tables)
      : scene_(scene), tables_(tables) {
    for (std::size_t k = 0; k < scene.script.size(); ++k) {
      const SceneAction& action = scene.script[k];
      members_.push_back(members_of(scene, action.body).value_or(SceneMembers{}));
      if (action.id.empty()) continue;
      positions_.emplace(action.id, k);
      ids_.push_back(action.id);
    }
  }

  void check() {
    for (std::size_t k = 0; k < scene_.script.size(); ++k) {
      const auto* const stop = std::get_if<SceneStop>(&scene_.script[k].deed);
      if (stop != nullptr && !stop->action.empty()) check_reference(k, "action");
      if (!scene_.script[k].after.empty()) check_reference(k, "after");
    }
    for (std::size_t k = 0; k < scene_.script.size(); ++k) check_chain(k);
    for (std::size_t k = 0; k < scene_.script.size(); ++k) check_wait(k);
  }

 private:
  const std::string& name_in(std::size_t k, std::string_view key) const {
    const SceneAction& action = scene_.script[k];
    return key == "after" ? action.after : std::get<SceneStop>(action.deed).action;
  }

  void check_reference(std::size_t k, std::string_view key) {
    const std::string& id = name_in(k, key);
    const auto found = positions_.find(id);
    if (found == positions_.end()) {
      fail_unknown(tables_[k], key, "action", id, ids_);
    } else if (!is_within(members_[k], members_[found->second])) {
      tables_[k].fail(key,
                      in_quotes(id) + " is an action of other bodies",
                      "name an action of " + in_quotes(scene_.script[k].body));
    }
  }

  /// Follows the actions that each waits for.
  void check_chain(std::size_t start) {
    std::string text = in_quotes(scene_.script[start].id);
    std::size_t at = start;
    for (std::size_t n = 0; tables_[start].ok(); ++n) {
      const auto next = positions_.find(scene_.script[at].after);
      if (next == positions_.end()) return;
      at = next->second;
      // A longer text would not be read.
      if (n < 20) text += " after " + in_quotes(scene_.script[at].id);
      if (at == start) {
        tables_[start].fail(
            "after", "actions wait for each other: " + text, "give one a time_s instead");
      }
      if (n > scene_.script.size()) return;  // A cycle that does not hold the start.
    }
  }

  /// True if the file stops an action without an end, other than by waiting for it.
  bool is_stopped(std::size_t k) const {
    const SceneAction& action = scene_.script[k];
    for (std::size_t s = 0; s < scene_.script.size(); ++s) {
      const SceneAction& stopping = scene_.script[s];
      const auto* const stop = std::get_if<SceneStop>(&stopping.deed);
      if (stop == nullptr || !is_within(members_[k], members_[s])) continue;
      const bool is_meant = stop->action.empty()
                                ? !stop->layer || *stop->layer == action.layer
                                : stop->action == action.id;
      const bool waits_for_it = stopping.after == action.id && stopping.event.empty();
      const bool can_be_later =
          !stopping.after.empty() || stopping.time_s > action.time_s;
      if (is_meant && !waits_for_it && can_be_later) return true;
    }
    return false;
  }

  void check_wait(std::size_t k) {
    const SceneAction& action = scene_.script[k];
    if (!tables_[k].ok() || action.after.empty() || !action.event.empty()) return;
    const std::size_t before = positions_.at(action.after);
    if (!is_endless(scene_.script[before]) || is_stopped(before)) return;
    tables_[k].fail("after",
                    "the action waits for the end of " + in_quotes(action.after) +
                        ", which has no end",
                    "give " + in_quotes(action.after) +
                        " for_s, stop it, or wait for an event of it");
  }

  const Scene& scene_;
  std::vector<TomlReader>& tables_;
  std::vector<SceneMembers> members_;
  std::map<std::string_view, std::size_t> positions_;
  std::vector<std::string> ids_;
};

void check_cycles(const Scene& scene, std::vector<TomlReader>& tables) {
  const std::vector<SceneDependency> all = scene_dependencies(scene);
  if (all.size() > kMaxDependencies) {
    tables[all[kMaxDependencies].action].fail(
        "",
        "more than 20000 bodies follow points of other bodies",
        "reduce the groups, or write last_step = true in the targets");
    return;
  }
  const auto cycle = find_cycle(all, body_count(scene));
  if (!cycle) return;
  const std::vector<SceneBody> bodies = scene_bodies(scene);
  std::string cause = "bodies depend on each other in the same step, at ";
  append_exact(cause, cycle->time_s);
  cause += " s: ";
  constexpr std::size_t kShown = 10;
  std::size_t latest = 0;
  for (std::size_t k = 0; k < cycle->links.size(); ++k) {
    const SceneDependency& link = cycle->links[k];
    latest = std::max(latest, link.action);
    if (k < kShown) cause += bodies[link.body].id + " on ";
    if (k == kShown) cause += "... on ";
  }
  cause += bodies[cycle->links.back().on].id;
  tables[latest].fail("",
                      std::move(cause),
                      "end one action with for_s or a stop before the other starts, or "
                      "write last_step = true in one target");
}

}  // namespace

void read_script(TomlReader& root, Scene& scene) {
  check_count(root, "at", kMaxTables);
  std::vector<TomlReader> tables = root.tables("at");
  std::vector<std::string> ids;
  for (TomlReader& table : tables) {
    SceneAction action = read_action(table, scene, ids);
    if (!root.ok()) return;
    scene.script.push_back(std::move(action));
  }
  ActionCheck(scene, tables).check();
  if (root.ok()) check_cycles(scene, tables);
}

}  // namespace marey::recordings::stage
