// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/content_to_detect.h"

#include <variant>

namespace marey::app {

using recordings::Trial;

namespace {

std::vector<TagFamilyUse> families_to_find(const recordings::Session& session) {
  if (session.families.size() == 1) return {{session.families.front().name, {}}};
  return session.families;
}

}  // namespace

ContentToDetect content_to_detect(const recordings::Session& session,
                                  const Trial& trial) {
  ContentToDetect wanted;
  if (!session.families.empty()) wanted.families = families_to_find(session);
  const bool shows_target = trial.kind == recordings::TrialKind::kCalibration ||
                            trial.kind == recordings::TrialKind::kFloor;
  if (shows_target && has_points(session.target)) wanted.target = session.target;
  wanted.shows_grid = shows_target && std::holds_alternative<AprilGrid>(session.target);
  if (wanted.shows_grid && trial.kind == recordings::TrialKind::kCalibration) {
    wanted.grid = std::get<AprilGrid>(session.target);
  }
  return wanted;
}

}  // namespace marey::app
