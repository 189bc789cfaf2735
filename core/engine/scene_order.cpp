// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/engine/scene_order.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "core/base/assert.h"

namespace marey {
namespace {

bool covers(const SceneMembers& all, const SceneMembers& some) {
  return all.first <= some.first && some.first + some.count <= all.first + all.count;
}

/// Computes the times of actions; each action after the one that it waits for.
class ActionTimes {
 public:
  explicit ActionTimes(const Scene& scene)
      : scene_(scene), bound_s_(scene.script.size(), scene.duration_s) {
    for (std::size_t k = 0; k < scene.script.size(); ++k) {
      const SceneAction& action = scene.script[k];
      if (!action.id.empty()) by_id_.emplace(action.id, k);
      members_.push_back(members_of(scene, action.body));
    }
  }

  std::vector<ActionTime> compute() {
    pass();
    // Stops shorten the actions, which may shorten others that wait for them.
    for (std::size_t k = 0; k < scene_.script.size(); ++k) apply_stop(k);
    pass();
    return times_;
  }

 private:
  void pass() {
    times_.assign(scene_.script.size(), {});
    done_.assign(scene_.script.size(), false);
    for (std::size_t k = 0; k < scene_.script.size(); ++k) compute(k);
  }

  void compute(std::size_t k) {
    // From the first action of the chain to the last one.
    std::vector<std::size_t> chain;
    for (std::optional<std::size_t> at = k; at && !done_[*at];) {
      MAREY_ASSERT(chain.size() <= scene_.script.size());
      chain.push_back(*at);
      at = position_of(scene_.script[*at].after);
    }
    for (auto at = chain.rbegin(); at != chain.rend(); ++at) compute_one(*at);
  }

  void compute_one(std::size_t k) {
    const SceneAction& action = scene_.script[k];
    ActionTime& time = times_[k];
    time.start_s = action.time_s;
    time.latest_start_s = action.time_s;
    if (const auto before = position_of(action.after)) {
      const ActionTime& other = times_[*before];
      const SceneAction& first = scene_.script[*before];
      const bool waits_for_end = action.event.empty() && first.for_s;
      const double earliest_s = other.start_s + (waits_for_end ? *first.for_s : 0.0);
      time.start_s = std::max(action.time_s, earliest_s);
      const double latest_s = waits_for_end && other.start_s == other.latest_start_s
                                  ? time.start_s
                                  : other.end_s;
      time.latest_start_s = std::max(time.start_s, latest_s);
    }
    double end_s = bound_s_[k];
    if (action.for_s) {
      const double fade_s = action.fade_out_s.value_or(kAssumedFade_s);
      end_s = std::min(end_s, time.latest_start_s + *action.for_s + fade_s);
    }
    time.end_s = std::max(time.start_s, end_s);
    done_[k] = true;
  }

  void apply_stop(std::size_t k) {
    const SceneAction& stopping = scene_.script[k];
    const auto* const stop = std::get_if<SceneStop>(&stopping.deed);
    const auto& stopped = members_[k];
    if (stop == nullptr || !stopped) return;
    for (std::size_t i = 0; i < scene_.script.size(); ++i) {
      const SceneAction& action = scene_.script[i];
      const bool is_meant = stop->action.empty()
                                ? !stop->layer || *stop->layer == action.layer
                                : stop->action == action.id;
      if (!is_meant || times_[i].latest_start_s > times_[k].start_s) continue;
      if (!members_[i] || !covers(*stopped, *members_[i])) continue;
      const double fade_s =
          stopping.fade_out_s.value_or(action.fade_out_s.value_or(kAssumedFade_s));
      bound_s_[i] = std::min(bound_s_[i], times_[k].latest_start_s + fade_s);
    }
  }

  std::optional<std::size_t> position_of(const std::string& id) const {
    const auto found = by_id_.find(id);
    if (found == by_id_.end()) return std::nullopt;
    return found->second;
  }

  const Scene& scene_;
  std::map<std::string_view, std::size_t> by_id_;
  std::vector<std::optional<SceneMembers>> members_;
  std::vector<double> bound_s_;
  std::vector<ActionTime> times_;
  std::vector<bool> done_;
};

/// Finds a cycle among some dependencies by following them from every body.
class CycleSearch {
 public:
  CycleSearch(const std::vector<SceneDependency>& all, std::size_t bodies)
      : all_(all), first_(bodies + 1, 0), state_(bodies, State::kNew) {}

  /// Searches the links that are active at a time; nullopt: at any time.
  std::vector<SceneDependency> find(std::optional<double> time_s) {
    gather(time_s);
    std::fill(state_.begin(), state_.end(), State::kNew);
    for (std::size_t body = 0; body < state_.size(); ++body) {
      if (state_[body] != State::kNew) continue;
      std::vector<SceneDependency> cycle = follow(body);
      if (!cycle.empty()) return cycle;
    }
    return {};
  }

 private:
  enum class State : unsigned char { kNew, kOpen, kDone };
  struct Visit {
    std::size_t body = 0;
    std::size_t next = 0;  // In links_.
  };

  void gather(std::optional<double> time_s) {
    links_.clear();
    for (const SceneDependency& link : all_) {
      const bool is_active =
          !time_s || (link.start_s <= *time_s && *time_s <= link.end_s);
      if (is_active) links_.push_back(&link);
    }
    std::stable_sort(links_.begin(), links_.end(), [](const auto* a, const auto* b) {
      return a->body < b->body;
    });
    std::fill(first_.begin(), first_.end(), 0);
    for (const SceneDependency* link : links_) ++first_[link->body + 1];
    for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  }

  std::vector<SceneDependency> follow(std::size_t start) {
    std::vector<Visit> path{{start, first_[start]}};
    state_[start] = State::kOpen;
    while (!path.empty()) {
      Visit& here = path.back();
      if (here.next == first_[here.body + 1]) {
        state_[here.body] = State::kDone;
        path.pop_back();
        continue;
      }
      const std::size_t on = links_[here.next++]->on;
      if (state_[on] == State::kOpen) return cycle_of(path, on);
      if (state_[on] == State::kDone) continue;
      state_[on] = State::kOpen;
      path.push_back({on, first_[on]});
    }
    return {};
  }

  std::vector<SceneDependency> cycle_of(const std::vector<Visit>& path,
                                        std::size_t body) const {
    std::vector<SceneDependency> cycle;
    auto at = std::find_if(
        path.begin(), path.end(), [&](const Visit& one) { return one.body == body; });
    for (; at != path.end(); ++at) cycle.push_back(*links_[at->next - 1]);
    return cycle;
  }

  const std::vector<SceneDependency>& all_;
  std::vector<const SceneDependency*> links_;
  std::vector<std::size_t> first_;
  std::vector<State> state_;
};

}  // namespace

std::vector<ActionTime> action_times(const Scene& scene) {
  return ActionTimes(scene).compute();
}

std::vector<SceneDependency> scene_dependencies(const Scene& scene) {
  std::vector<SceneDependency> dependencies;
  const std::vector<ActionTime> times = action_times(scene);
  for (std::size_t k = 0; k < scene.script.size(); ++k) {
    const SceneAction& action = scene.script[k];
    const SceneTarget* const target = scene.target(target_of(action));
    if (target == nullptr) continue;
    const auto* const path = std::get_if<BodyPointPath>(&target->path);
    if (path == nullptr || path->last_step) continue;
    const auto users = members_of(scene, action.body);
    const auto partners = members_of(scene, path->body);
    if (!users || !partners) continue;
    if (partners->count != 1 && partners->count != users->count) continue;
    for (std::size_t i = 0; i < users->count; ++i) {
      dependencies.push_back(
          {users->first + i, partners->partner(i), k, times[k].start_s, times[k].end_s});
    }
  }
  return dependencies;
}

std::optional<DependencyCycle> find_cycle(
    const std::vector<SceneDependency>& dependencies, std::size_t bodies) {
  CycleSearch search(dependencies, bodies);
  if (search.find(std::nullopt).empty()) return std::nullopt;
  // Links become active at their starts only: a cycle exists first at one of them.
  std::set<double> starts;
  for (const SceneDependency& link : dependencies) starts.insert(link.start_s);
  for (const double time_s : starts) {
    std::vector<SceneDependency> cycle = search.find(time_s);
    if (!cycle.empty()) return DependencyCycle{time_s, std::move(cycle)};
  }
  return std::nullopt;
}

void solve_rounds(const std::vector<SceneDependency>& dependencies,
                  double time_s,
                  std::size_t bodies,
                  std::vector<std::size_t>& rounds) {
  constexpr std::size_t kWaiting = std::numeric_limits<std::size_t>::max();
  rounds.assign(bodies, kWaiting);
  std::size_t placed = 0;
  for (std::size_t round = 0; placed < bodies; ++round) {
    for (std::size_t& of_body : rounds) {
      if (of_body == kWaiting) of_body = round;
    }
    for (const SceneDependency& link : dependencies) {
      if (time_s < link.start_s || link.end_s < time_s) continue;
      // The other one is placed in this round at the earliest.
      if (rounds[link.body] == round && rounds[link.on] >= round) {
        rounds[link.body] = kWaiting;
      }
    }
    const std::size_t placed_before = placed;
    for (const std::size_t of_body : rounds) placed += of_body == round ? 1 : 0;
    MAREY_ASSERT(placed > placed_before);
  }
}

}  // namespace marey
