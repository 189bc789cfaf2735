// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/check/check_page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include <nlohmann/json.hpp>

#include "app/library/check/check_json.h"
#include "app/pages/fill_page.h"
#include "app/pages/report_json.h"
#include "app/pages/report_page.h"

namespace marey::app {
namespace {

using PageJson = nlohmann::ordered_json;

/// Rounds to four digits, so that the file stays small.
double four_digits(double value) {
  constexpr int kDigits = 4;
  constexpr int kMaxDecimals = 9;
  if (value == 0.0) return 0.0;
  const int whole = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return rounded(value, std::clamp(kDigits - whole, 0, kMaxDecimals));
}

/// Writes clips for the page: figures by their place in check.figures, kinds of problems
/// by theirs in check.kinds.
class ClipRows {
 public:
  explicit ClipRows(const LibraryCheck& check) {
    for (std::size_t i = 0; i < check.figures.size(); ++i) {
      figures_[check.figures[i].figure] = i;
    }
    for (std::size_t i = 0; i < check.kinds.size(); ++i) {
      kinds_[check.kinds[i].kind] = i;
    }
  }

  /// Returns a list: id, name, source, verdict, frames, rate, a value (or null) for each
  /// figure, a digit (or '-') for each verdict, places of figures with a warning or a
  /// failure, problems.
  [[nodiscard]] PageJson row(const ClipRecord& clip) const {
    PageJson values = PageJson::array();
    for (std::size_t i = 0; i < figures_.size(); ++i) values.push_back(nullptr);
    std::string verdicts(figures_.size(), '-');
    PageJson places = PageJson::array();
    for (const ClipFigure& figure : clip.figures) {
      const std::size_t column = figures_.find(figure.name)->second;
      values[column] = four_digits(figure.value);
      if (!figure.verdict) continue;
      verdicts[column] = static_cast<char>('0' + static_cast<int>(*figure.verdict));
      if (*figure.verdict == Verdict::kPass) continue;
      places.push_back({column,
                        figure.joint,
                        figure.frames ? figure.frames->first : -1,
                        figure.frames ? figure.frames->last : -1});
    }
    PageJson problems = PageJson::array();
    for (const ClipProblem& problem : clip.problems) {
      problems.push_back({kinds_.find(problem.kind)->second,
                          problem.joint,
                          problem.frames.first,
                          problem.frames.last,
                          four_digits(problem.value),
                          static_cast<int>(verdict_of_kind(clip, problem.kind))});
    }
    return {clip.clip_id,
            clip.name,
            clip.provenance.path,
            static_cast<int>(clip.quality),
            clip.frame_count(),
            clip.rate_hz,
            values,
            verdicts,
            places,
            problems};
  }

 private:
  std::map<std::string, std::size_t, std::less<>> figures_;
  std::map<std::string, std::size_t, std::less<>> kinds_;
};

}  // namespace

std::string check_page(const LibraryCheck& check) {
  const ClipRows rows(check);
  PageJson clips = PageJson::array();
  const std::size_t count = std::min(check.worst_first.size(), kMaxPageClips);
  for (std::size_t i = 0; i < count; ++i) {
    clips.push_back(rows.row(check.clips[check.worst_first[i]]));
  }
  const PageJson data = {{"summary", check_summary_json(check)},
                         {"folder", check.folder},
                         {"left_out", check.worst_first.size() - count},
                         {"clips", clips}};
  return fill_page(
      library_check_page(),
      {{"style", std::string(report_style()) + std::string(library_check_style())},
       {"data", json_in_html(data)},
       {"script", std::string(library_check_script())}});
}

}  // namespace marey::app
