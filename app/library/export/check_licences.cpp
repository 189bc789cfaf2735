// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/export/check_licences.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

std::string number_of_clips(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " clip" : " clips");
}

/// Appends `text` to a list with commas.
void append_item(std::string& list, const std::string& text) {
  if (!list.empty()) list += ", ";
  list += text;
}

/// Returns true if a build left out frames of the source, or changed its motion.
bool is_changed_by_build(const ClipRecord& record) {
  return std::ranges::any_of(record.figures, [](const ClipFigure& figure) {
    const bool is_change =
        figure.name == "left_out_frames" || figure.name == "cleaned_samples";
    return is_change && figure.value > 0.0;
  });
}

/// Returns the licences of a refused group that the user would have to permit by name.
std::vector<std::string> to_permit(const LicenceGroup& group,
                                   const ExportOptions& options) {
  if (group.decision.applied.size() <= 1) return group.decision.applied;
  std::vector<std::string> out;
  for (const std::string& licence : group.decision.applied) {
    const auto alone = library::decide_licence(licence, true, options.allowance);
    if (alone.bar != library::LicenceBar::kNone) out.push_back(licence);
  }
  return out;
}

}  // namespace

std::vector<LicenceGroup> decide_licences(std::span<const ClipRecord* const> clips,
                                          const ExportOptions& options) {
  std::map<std::string, LicenceGroup> groups;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const std::string& stated = clips[i]->provenance.licence;
    const std::string expression = stated.empty() ? "unknown" : stated;
    const bool is_changed =
        changes_clip(options, clips[i]->rate_hz) || is_changed_by_build(*clips[i]);
    const auto [at, is_new] = groups.try_emplace(expression);
    LicenceGroup& group = at->second;
    if (is_new || group.decision.bar == library::LicenceBar::kNone) {
      group.expression = expression;
      group.decision = library::decide_licence(expression, is_changed, options.allowance);
    }
    group.clips.push_back(i);
  }
  std::vector<LicenceGroup> out;
  for (auto& [expression, group] : groups) out.push_back(std::move(group));
  return out;
}

Status check_licences(std::span<const LicenceGroup> groups,
                      const ExportOptions& options) {
  std::string refused;
  std::string permit;
  bool is_unknown = false;
  std::size_t count = 0;
  for (const LicenceGroup& group : groups) {
    if (group.decision.bar == library::LicenceBar::kNone) continue;
    count += group.clips.size();
    append_item(refused,
                group.expression + " (" + number_of_clips(group.clips.size()) + ") " +
                    std::string(library::name(group.decision.bar)));
    if (group.decision.bar == library::LicenceBar::kUnknown) {
      is_unknown = true;
      continue;
    }
    for (const std::string& licence : to_permit(group, options)) {
      if (permit.find(licence) == std::string::npos) {
        if (!permit.empty()) permit += ',';
        permit += licence;
      }
    }
  }
  if (count == 0) return Done{};
  std::string next = "if your use is permitted, add";
  if (!permit.empty()) {
    const bool has_blank = permit.find(' ') != std::string::npos;
    next += " --allow-licence " + (has_blank ? in_quotes(permit) : permit);
  }
  if (is_unknown)
    next += std::string(permit.empty() ? "" : " and") + " --licence-unknown";
  next += "; else leave these clips out with --query";
  return bad_input(
      options.library.string(),
      "licences do not permit this export of " + number_of_clips(count) + ": " + refused,
      next);
}

}  // namespace marey::app
