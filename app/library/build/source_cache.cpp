// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/source_cache.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using CacheJson = nlohmann::ordered_json;
using recordings::FileStat;
using recordings::stat_file;

constexpr std::int64_t kSettled_ns = 2'000'000'000;

std::string cache_key(const fs::path& path) {
  std::error_code failed;
  return fs::absolute(path, failed).lexically_normal().string();
}

fs::path cache_file(const fs::path& library) {
  return recordings::LibraryPaths(library).cache() / "sources.jsonl";
}

std::optional<std::pair<std::string, FileStat>> read_stat(const CacheJson& item) {
  if (!item.is_array() || item.size() != 4 || !item[0].is_string() ||
      !item[1].is_number_unsigned() || !item[2].is_number_integer() ||
      !item[3].is_number_unsigned()) {
    return std::nullopt;
  }
  return std::pair(item[0].get<std::string>(),
                   FileStat{item[1].get<std::uint64_t>(),
                            item[2].get<std::int64_t>(),
                            item[3].get<std::uint64_t>()});
}

/// Calls `visit` with each line of a text.
template <class Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    visit(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
}

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

bool KnownSource::is_current() const {
  return std::ranges::all_of(
             files,
             [](const auto& file) { return stat_file(file.first) == file.second; }) &&
         std::ranges::none_of(
             absent, [](const std::string& file) { return stat_file(file).has_value(); });
}

Error changed_while_read(const SourceFile& file) {
  return bad_input(file.path.string(),
                   "the file changed while it was read",
                   "build the library again when nothing writes to its sources");
}

Result<KnownSource> know_source(const SourceFile& file) {
  const std::int64_t start_ns = now_ns();
  auto identified = identify_source(file);
  if (!identified) return identified.error();
  KnownSource out;
  for (const fs::path& part : identified->parts.files) {
    out.files.emplace_back(part.string(), stat_file(part).value_or(FileStat{}));
  }
  for (const fs::path& part : identified->parts.absent) {
    out.absent.push_back(part.string());
  }
  out.id = std::move(identified->id);
  const bool is_recent = std::ranges::any_of(
      out.files, [&](const auto& part) { return part.second.changed_ns >= start_ns; });
  if (!is_recent) return out;
  // Changed meanwhile, or its time is in the future.
  identified = identify_source(file);
  if (!identified) return identified.error();
  if (identified->id != out.id) return changed_while_read(file);
  return out;
}

std::string known_source_text(const KnownSource& source) {
  CacheJson files = CacheJson::array();
  for (const auto& [path, state] : source.files) {
    files.push_back(CacheJson::array({path, state.bytes, state.changed_ns, state.inode}));
  }
  const CacheJson json = {{"id", source.id}, {"files", files}, {"absent", source.absent}};
  return json.dump(-1, ' ', false, CacheJson::error_handler_t::replace);
}

std::optional<KnownSource> parse_known_source(std::string_view text) {
  const CacheJson root = CacheJson::parse(text, nullptr, false);
  if (!root.is_object() || !root.contains("id") || !root.at("id").is_string() ||
      !root.contains("files") || !root.at("files").is_array() ||
      !root.contains("absent") || !root.at("absent").is_array()) {
    return std::nullopt;
  }
  KnownSource out;
  out.id = root.at("id").get<std::string>();
  for (const CacheJson& item : root.at("files")) {
    auto file = read_stat(item);
    if (!file) return std::nullopt;
    out.files.push_back(std::move(*file));
  }
  for (const CacheJson& item : root.at("absent")) {
    if (!item.is_string()) return std::nullopt;
    out.absent.push_back(item.get<std::string>());
  }
  return out;
}

SourceCache SourceCache::read(const fs::path& library) {
  SourceCache out;
  std::error_code failed;
  const fs::path file = cache_file(library);
  if (!fs::is_regular_file(file, failed)) return out;
  const auto text = recordings::read_file(file);
  if (!text) return out;
  std::string path;
  for_each_line(*text, [&](std::string_view line) {
    if (path.empty()) {
      path = line;
      return;
    }
    if (auto source = parse_known_source(line)) {
      out.sources_.insert_or_assign(path, std::move(*source));
    }
    path.clear();
  });
  return out;
}

const KnownSource* SourceCache::find(const fs::path& path) const {
  const auto found = sources_.find(cache_key(path));
  if (found == sources_.end() || !found->second.is_current()) return nullptr;
  used_[found->first] = &found->second;
  return &found->second;
}

void SourceCache::add(const fs::path& path, KnownSource source) {
  const std::int64_t until_ns = now_ns() - kSettled_ns;
  const bool is_settled = std::ranges::all_of(
      source.files, [&](const auto& file) { return file.second.changed_ns < until_ns; });
  const std::string key = cache_key(path);
  // Lines of the file hold paths.
  if (!is_settled || key.find('\n') != std::string::npos) return;
  const auto place = sources_.insert_or_assign(key, std::move(source)).first;
  used_[place->first] = &place->second;
}

Status SourceCache::write(const fs::path& library) const {
  std::string text;
  for (const auto& [path, source] : used_) {
    text += path + "\n" + known_source_text(*source) + "\n";
  }
  return recordings::write_file(cache_file(library), text);
}

}  // namespace marey::app
