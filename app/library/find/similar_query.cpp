// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/find/similar_query.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <string_view>
#include <system_error>

#include "library/clips/normal_form.h"
#include "library/clips/put_on_floor.h"
#include "library/features/body_features.h"
#include "library/features/feature_span.h"

#include "app/motion/retarget_files.h"
#include "app/shell/word_list.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "recordings/library/library_paths.h"
#include "recordings/library/library_records.h"
#include "recordings/library/motion_object.h"
#include "recordings/library/select_clips.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::ClipSelector;
using recordings::ClipSet;
using recordings::ClipSummary;
using recordings::ClipText;

using QueriedSeconds = std::pair<double, double>;

std::optional<double> whole_number(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data(), end, value);
  const bool is_valid =
      problem == std::errc() && rest == end && std::isfinite(value) && !text.empty();
  return is_valid ? std::optional(value) : std::nullopt;
}

std::vector<int> numbers_in(const ClipSet& set) {
  std::vector<int> out;
  for (std::size_t k = 0; k < set.size(); ++k) {
    if (set[k]) out.push_back(static_cast<int>(k));
  }
  return out;
}

Error several_clips(const std::string& word, std::span<const ClipSummary> clips) {
  constexpr std::size_t kListed = 5;
  std::vector<std::string> ids;
  for (const ClipSummary& clip : clips.first(std::min(kListed, clips.size()))) {
    ids.push_back(clip.clip_id + " (" + in_quotes(clip.name) + ")");
  }
  return bad_input(
      in_quotes(word),
      format_text("%zu clips are called so or have an id that begins so", clips.size()),
      "give the id of one: " + or_list(ids));
}

Error no_clip(const fs::path& index, const std::string& word) {
  constexpr int kSearched = 5000;
  constexpr std::size_t kListed = 3;
  Error out =
      bad_input(in_quotes(word),
                "it is no clip of the library, and no file",
                "list the clips: marey library query " + index.parent_path().string());
  const auto clips = recordings::read_clip_summaries(index, 0, kSearched);
  if (!clips || clips->empty()) return out;
  std::vector<std::string_view> names;
  for (const ClipSummary& clip : *clips) names.emplace_back(clip.name);
  std::vector<std::string> nearest;
  for (const std::string_view name : nearest_words(word, names, kListed)) {
    nearest.push_back(in_quotes(name));
  }
  out.next = "perhaps you mean " + or_list(nearest) + "; " + out.next;
  return out;
}

/// Keeps the rows from second `a` to `b`. `start_s` is the time of the first one.
Status cut_rows(const QueriedSeconds& range,
                double start_s,
                double duration_s,
                const std::string& name,
                std::vector<float>& rows) {
  constexpr double kRounding_s = 1e-6;
  const auto [a, b] = range;
  if (!(a >= 0.0) || !(b > a) || b > duration_s + 0.1) {
    return bad_usage(
        "@" + format_text("%g-%g", a, b),
        format_text(
            "it is no part of %s, which has %.2f s", in_quotes(name).c_str(), duration_s),
        "give two times in seconds since its first frame, such as @0.5-2.5");
  }
  const auto count = static_cast<double>(rows.size() / library::kFeatureStride);
  const double hz = library::kFeatureRate_hz;
  const double first =
      std::clamp(std::ceil((a - start_s - kRounding_s) * hz), 0.0, count - 1.0);
  const double last =
      std::clamp(std::floor((b - start_s + kRounding_s) * hz), first, count - 1.0);
  const auto at = [](double row) {
    return static_cast<std::ptrdiff_t>(row) * library::kFeatureStride;
  };
  rows = std::vector<float>(rows.begin() + at(first), rows.begin() + at(last + 1.0));
  return Done{};
}

/// Features of a file, and their times.
struct FileFeatures {
  library::BodyFeatures features;
  double duration_s = 0.0;
};

Result<FileFeatures> read_file_features(const fs::path& file) {
  auto read = read_motion(file);
  if (!read) return read.error();
  const auto in_file = [&](const Error& error) {
    return bad_input(file.string(), error.cause, error.next);
  };
  auto clip = library::make_library_motion(read->motion);
  if (!clip) return in_file(clip.error());
  const auto map = retarget::map_body(clip->motion.skeleton);
  if (!map) return in_file(map.error());
  library::put_on_floor(clip->motion, *map);
  // As an object of a library has it: rounded, and without ends of bones.
  const auto bytes = recordings::motion_object_bytes(*clip);
  if (!bytes) return in_file(bytes.error());
  const auto stored = recordings::parse_motion_object(*bytes, file.string());
  if (!stored) return stored.error();
  const auto stored_map = retarget::map_body(stored->motion.skeleton);
  if (!stored_map) return in_file(stored_map.error());
  FileFeatures out;
  out.features = library::body_features(stored->motion, *stored_map);
  out.duration_s =
      static_cast<double>(stored->motion.poses.size() - 1) / stored->motion.rate.hz;
  return out;
}

}  // namespace

std::pair<std::string, std::optional<QueriedSeconds>> divide_range(
    const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || at == 0) return {text, std::nullopt};
  const std::string_view range = std::string_view(text).substr(at + 1);
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return {text, std::nullopt};
  const auto a = whole_number(range.substr(0, dash));
  const auto b = whole_number(range.substr(dash + 1));
  if (!a || !b) return {text, std::nullopt};
  return {text.substr(0, at), QueriedSeconds{*a, *b}};
}

Result<int> find_clip(const fs::path& library, const std::string& word) {
  constexpr std::size_t kMinDigits = 4;
  const fs::path index = recordings::LibraryPaths(library).index();
  const auto selector = ClipSelector::open(index);
  if (!selector) return selector.error();
  for (const ClipText which : {ClipText::kId, ClipText::kName}) {
    const auto set = selector->with_text(which, word);
    if (!set) return set.error();
    const std::vector<int> numbers = numbers_in(*set);
    if (numbers.size() == 1) return numbers.front();
    if (numbers.empty()) continue;
    const auto clips = recordings::read_clip_summaries(index, numbers);
    if (!clips) return clips.error();
    return several_clips(word, *clips);
  }
  if (word.size() < kMinDigits) return no_clip(index, word);
  const auto set = selector->with_part_of_text(ClipText::kId, word);
  if (!set) return set.error();
  auto clips = recordings::read_clip_summaries(index, numbers_in(*set));
  if (!clips) return clips.error();
  std::erase_if(*clips,
                [&](const auto& clip) { return !clip.clip_id.starts_with(word); });
  if (clips->size() == 1) return clips->front().number;
  return clips->empty() ? no_clip(index, word) : several_clips(word, *clips);
}

Result<SimilarQuery> read_similar_query(const fs::path& library,
                                        const std::string& text,
                                        const OpenedSearch& search) {
  SimilarQuery out;
  std::error_code ignored;
  auto [word, range] = divide_range(text);
  // A file may have an @ in its name.
  if (fs::is_regular_file(text, ignored)) {
    word = text;
    range.reset();
  }
  out.has_range = range.has_value();
  double start_s = 0.0;
  double duration_s = 0.0;
  if (fs::is_regular_file(word, ignored)) {
    auto read = read_file_features(word);
    if (!read) return read.error();
    out.name = word;
    out.rows = std::move((*read).features.rows);
    start_s = read->features.start_s;
    duration_s = read->duration_s;
  } else {
    const auto number = find_clip(library, word);
    if (!number) return number.error();
    const std::vector<int> numbers = {*number};
    const auto records = recordings::read_library_records(
        recordings::LibraryPaths(library).index(), numbers);
    if (!records) return records.error();
    const ClipRecord& record = records->front();
    const std::span<const float> rows = search.rows().features.rows(*number);
    out.rows.assign(rows.begin(), rows.end());
    out.clip = *number;
    out.name = record.name;
    duration_s = record.duration_s();
    if (record.rate_hz > 0.0) {
      start_s =
          library::feature_span(record.first_frame, record.last_frame, record.rate_hz)
              .start_s;
    }
  }
  if (out.rows.empty()) {
    return bad_input(in_quotes(out.name), "it has no frames", "choose another motion");
  }
  if (range) {
    const Status ok = cut_rows(*range, start_s, duration_s, out.name, out.rows);
    if (!ok) return ok.error();
  }
  return out;
}

}  // namespace marey::app
