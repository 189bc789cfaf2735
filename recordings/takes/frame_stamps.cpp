// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/frame_stamps.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/assert.h"
#include "core/base/in_quotes.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/csv_line.h"
#include "recordings/base/text_reader.h"

namespace marey::recordings {
namespace {

constexpr const char* kNext =
    "correct it: a line for each frame, with cam_id and frame_time in seconds; or leave "
    "\"timestamps\" out of the trial";

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  CsvFields rest(line);
  while (!rest.ended()) fields.push_back(rest.text());
  return fields;
}

std::optional<std::size_t> column_of(const std::vector<std::string_view>& header,
                                     std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found != header.end()) return static_cast<std::size_t>(found - header.begin());
  }
  return std::nullopt;
}

/// Returns "2" for "cam_2"; empty for a name without a number at its end.
std::string_view number_at_end(std::string_view name) {
  const std::size_t last = name.find_last_not_of("0123456789");
  return last == std::string_view::npos ? name : name.substr(last + 1);
}

/// Returns the index of the video that the table's word refers to.
std::optional<std::size_t> video_called(std::string_view word,
                                        std::span<const std::string> videos) {
  const auto place = [&](const auto& found) -> std::optional<std::size_t> {
    if (found == videos.end()) return std::nullopt;
    return static_cast<std::size_t>(found - videos.begin());
  };
  if (const auto v = place(std::find(videos.begin(), videos.end(), word))) return v;
  return place(std::find_if(videos.begin(), videos.end(), [&](const std::string& video) {
    return !word.empty() && number_at_end(video) == word;
  }));
}

class StampsParser {
 public:
  StampsParser(std::string_view text,
               std::string file,
               std::span<const std::string> videos)
      : lines_(text), file_(std::move(file)), videos_(videos), seen_s_(videos.size()) {}

  Result<std::vector<std::vector<Timestamp>>> parse() {
    const auto header = fields_of(lines_.next().value_or(""));
    const auto camera = column_of(header, {"cam_id", "camera", "port"});
    const auto time = column_of(header, {"frame_time"});
    if (!camera || !time) {
      return fail("its first line names no column " +
                  std::string(camera ? "frame_time" : "cam_id"));
    }
    while (const auto line = lines_.next()) {
      const auto fields = fields_of(*line);
      if (fields.size() != header.size()) {
        return fail("expected " + std::to_string(header.size()) + " fields, found " +
                    std::to_string(fields.size()));
      }
      if (const Status ok = take_row(fields[*camera], fields[*time]); !ok) {
        return ok.error();
      }
    }
    return finish();
  }

 private:
  Status take_row(std::string_view camera, std::string_view time) {
    // A century: times do not overflow.
    constexpr double kMax_s = 3e9;
    const auto c = video_called(camera, videos_);
    const auto at_s = to_number(time);
    if (!at_s || std::abs(*at_s) > kMax_s) {
      return fail(in_quotes(time) + " is not a time in seconds");
    }
    if (!c) return Done{};
    std::vector<double>& times_s = seen_s_[*c];
    if (!times_s.empty() && *at_s < times_s.back()) {
      return fail("this frame of camera " + in_quotes(camera) +
                  " is earlier than the one before it");
    }
    times_s.push_back(*at_s);
    return Done{};
  }

  Result<std::vector<std::vector<Timestamp>>> finish() const {
    double earliest_s = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < videos_.size(); ++c) {
      if (seen_s_[c].empty()) {
        return bad_input(file_,
                         "it has no times of video " + in_quotes(videos_[c]),
                         "in that file, name the camera like the video, or by the number "
                         "at the end of that name");
      }
      earliest_s = std::min(earliest_s, seen_s_[c].front());
    }
    std::vector<std::vector<Timestamp>> stamps;
    for (const std::vector<double>& times_s : seen_s_) {
      std::vector<Timestamp>& out = stamps.emplace_back();
      for (const double at_s : times_s) out.push_back(from_seconds(at_s - earliest_s));
    }
    return stamps;
  }

  [[nodiscard]] Error fail(const std::string& cause) const {
    return bad_input(
        file_ + ":" + std::to_string(std::max(1, lines_.number())), cause, kNext);
  }

  CsvLines lines_;
  std::string file_;
  std::span<const std::string> videos_;
  std::vector<std::vector<double>> seen_s_;
};

}  // namespace

Result<std::vector<std::vector<Timestamp>>> read_frame_stamps(
    const std::filesystem::path& path, std::span<const std::string> videos) {
  MAREY_ASSERT(!videos.empty());
  const auto text = read_file(path);
  if (!text) return text.error();
  return StampsParser(*text, path.string(), videos).parse();
}

}  // namespace marey::recordings
