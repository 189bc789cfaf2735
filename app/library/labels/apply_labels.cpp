// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/labels/apply_labels.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "app/library/labels/label_targets.h"
#include "core/base/in_quotes.h"
#include "recordings/base/number_text.h"
#include "recordings/base/sha256.h"

namespace marey::app {
namespace {

using recordings::LabelRow;

auto order_of(const ClipLabel& label) {
  return std::tie(label.start_s, label.text, label.end_s, label.by, label.certainty);
}

/// Returns the part of a label that is in a clip; nullopt: no part is. `begin_s` is
/// the time of the clip's first frame on the label's clock.
std::optional<ClipLabel> part_in(const LabelRow& row,
                                 const ClipRecord& clip,
                                 double begin_s) {
  const double end_s = clip.duration_s();
  const double from_s = row.start_s ? *row.start_s - begin_s : 0.0;
  const double to_s = row.end_s ? *row.end_s - begin_s : end_s;
  const double first_s = std::max(from_s, 0.0);
  const double last_s = std::min(to_s, end_s);
  if (last_s < first_s) return std::nullopt;
  const double half_frame_s = clip.rate_hz > 0.0 ? 0.5 / clip.rate_hz : 0.0;
  const bool is_remnant = last_s - first_s < half_frame_s &&
                          to_s - from_s >= half_frame_s && end_s >= half_frame_s;
  if (is_remnant) return std::nullopt;
  return ClipLabel{first_s, last_s, row.text, row.by, row.certainty};
}

std::string cause_of(const LabelRow& row, const LabelTarget& target) {
  const std::string name = in_quotes(row.target);
  if (target.kind == LabelTarget::Kind::kAmbiguous) {
    return "several sources are named " + name;
  }
  if (target.is_found()) return "its times are outside " + name;
  return "no clip or source is named " + name;
}

}  // namespace

std::vector<UnusedLabel> apply_labels(const LibraryLabels& labels,
                                      std::vector<ClipRecord>& records) {
  const LabelTargets targets(records);
  std::vector<bool> is_changed(records.size(), false);
  std::vector<UnusedLabel> unused;
  for (const LabelFile& file : labels.files) {
    for (const LabelRow& row : file.rows) {
      const LabelTarget target = targets.find(row.target);
      bool is_used = false;
      for (const std::size_t i : target.clips) {
        ClipRecord& clip = records[i];
        const bool is_of_source =
            target.kind == LabelTarget::Kind::kSource && clip.rate_hz > 0.0;
        const double begin_s = is_of_source ? clip.first_frame / clip.rate_hz : 0.0;
        const auto part = part_in(row, clip, begin_s);
        if (!part) continue;
        clip.labels.push_back(*part);
        is_changed[i] = true;
        is_used = true;
      }
      if (!is_used) unused.push_back({file.name, row.line, cause_of(row, target)});
    }
  }
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!is_changed[i]) continue;
    std::vector<ClipLabel>& of_clip = records[i].labels;
    std::ranges::sort(of_clip, {}, order_of);
    const auto same = std::ranges::unique(of_clip, {}, order_of);
    of_clip.erase(same.begin(), same.end());
  }
  return unused;
}

std::vector<Finding> unused_label_findings(std::span<const UnusedLabel> unused) {
  std::vector<Finding> out;
  for (std::size_t i = 0; i < unused.size();) {
    std::size_t end = i;
    while (end < unused.size() && unused[end].file == unused[i].file) ++end;
    const std::size_t count = end - i;
    out.push_back(fair_finding(
        "labels",
        unused[i].file + ":" + std::to_string(unused[i].line),
        unused[i].cause +
            (count > 1 ? "; " + std::to_string(count - 1) + " other lines are not used"
                       : ""),
        "correct the names, or remove the lines"));
    i = end;
  }
  return out;
}

std::string labels_digest(const ClipRecord& record) {
  constexpr std::size_t kDigits = 16;
  std::string text;
  const auto add = [&](std::string_view part) {
    text += std::to_string(part.size());
    text += ':';
    text += part;
  };
  for (const ClipLabel& label : record.labels) {
    recordings::append_exact(text, label.start_s);
    text += ' ';
    recordings::append_exact(text, label.end_s);
    text += ' ';
    recordings::append_exact(text, label.certainty);
    text += ' ';
    add(label.text);
    add(label.by);
    text += '\n';
  }
  return recordings::sha256(text).substr(0, kDigits);
}

}  // namespace marey::app
