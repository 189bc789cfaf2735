// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/edit/edit_journal.h"

#include <algorithm>
#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/shell/utc_now.h"
#include "core/base/assert.h"
#include "core/base/in_quotes.h"
#include "recordings/base/sha256.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kJournalFormat = 1;
constexpr std::array<std::string_view, 5> kCauses{"open", "edit", "undo", "redo", "file"};

bool is_inside_character(std::string_view text, std::size_t at) {
  return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0U) == 0x80U;
}

/// Bytes of `before` after the first `keep`, replaced by `text`.
struct TextChange {
  std::size_t keep = 0;
  std::size_t drop = 0;
  std::string_view text;
};

/// Returns the shortest such change, in whole characters of UTF-8.
TextChange change_between(std::string_view before, std::string_view after) {
  const std::size_t shorter = std::min(before.size(), after.size());
  std::size_t keep = 0;
  while (keep < shorter && before[keep] == after[keep]) ++keep;
  while (keep > 0 &&
         (is_inside_character(before, keep) || is_inside_character(after, keep))) {
    --keep;
  }
  std::size_t same = 0;  // At the end.
  while (same < shorter - keep &&
         before[before.size() - 1 - same] == after[after.size() - 1 - same]) {
    ++same;
  }
  while (same > 0 && (is_inside_character(before, before.size() - same) ||
                      is_inside_character(after, after.size() - same))) {
    --same;
  }
  return {
      keep, before.size() - keep - same, after.substr(keep, after.size() - keep - same)};
}

std::optional<EditCause> cause_of(std::string_view word) {
  for (std::size_t i = 0; i < kCauses.size(); ++i) {
    if (kCauses[i] == word) return static_cast<EditCause>(i);
  }
  return std::nullopt;
}

/// Reads the members of one line. After a member that is missing or of another type,
/// `is_good` is false.
class JournalMembers {
 public:
  explicit JournalMembers(const Json& line) : line_(line) {}

  std::string text(const char* member) {
    const auto found = line_.find(member);
    if (found == line_.end() || !found->is_string()) {
      is_good = false;
      return {};
    }
    return found->get<std::string>();
  }
  std::size_t count(const char* member) {
    const auto found = line_.find(member);
    constexpr std::uint64_t kMax = std::uint64_t{1} << 30;
    if (found == line_.end() || !found->is_number_unsigned() ||
        found->get<std::uint64_t>() > kMax) {
      is_good = false;
      return 0;
    }
    return found->get<std::size_t>();
  }
  [[nodiscard]] bool has(const char* member) const { return line_.contains(member); }

  bool is_good = true;

 private:
  const Json& line_;
};

EditRevision revision_in(JournalMembers& members) {
  EditRevision out;
  out.number = static_cast<int>(members.count("revision"));
  out.parent = static_cast<int>(members.count("parent"));
  const auto cause = cause_of(members.text("cause"));
  if (!cause) members.is_good = false;
  out.cause = cause.value_or(EditCause::kEdit);
  out.sha256 = members.text("sha256");
  out.time = members.text("time");
  return out;
}

}  // namespace

std::string_view name(EditCause cause) {
  return kCauses[static_cast<std::size_t>(cause)];
}

Result<EditJournal> EditJournal::open(const fs::path& path) {
  auto lines = recordings::LineJournal::open(path);
  if (!lines) return lines.error();
  EditJournal out(*std::move(lines));
  int number = 0;
  for (const std::string& line : out.lines_.take_lines()) {
    ++number;
    const auto cause = out.read_line(line);
    if (!cause) continue;
    return bad_input(path.string() + ":" + std::to_string(number),
                     *cause,
                     "move the journal away to start a new one; the recipe stays");
  }
  return out;
}

const EditRevision& EditJournal::revision(int number) const {
  MAREY_ASSERT(number >= 1 && number <= revision_count());
  return entries_[static_cast<std::size_t>(number - 1)].revision;
}

const std::string& EditJournal::text(int number) const {
  MAREY_ASSERT(number >= 1 && number <= revision_count());
  const Entry& entry = entries_[static_cast<std::size_t>(number - 1)];
  return entry.of ? entries_[static_cast<std::size_t>(*entry.of - 1)].text : entry.text;
}

/// Returns true if the revision is the next one, and an undo or a redo restores what it
/// has to.
bool EditJournal::follows(const Entry& entry) const {
  const EditRevision& revision = entry.revision;
  const int count = revision_count();
  if (revision.number != count + 1 || revision.parent != count) return false;
  switch (revision.cause) {
    case EditCause::kOpen:
      return count == 0 && !entry.of;
    case EditCause::kEdit:
    case EditCause::kFile:
      return count > 0 && !entry.of;
    case EditCause::kUndo:
      return can_undo() && entry.of == undo_.back();
    case EditCause::kRedo:
      return can_redo() && entry.of == redo_.back();
  }
  return false;
}

/// Adds the entry in memory. Precondition: follows(entry).
void EditJournal::take(Entry entry) {
  switch (entry.revision.cause) {
    case EditCause::kOpen:
      break;
    case EditCause::kEdit:
    case EditCause::kFile:
      undo_.push_back(content_);
      redo_.clear();
      break;
    case EditCause::kUndo:
      redo_.push_back(content_);
      undo_.pop_back();
      break;
    case EditCause::kRedo:
      undo_.push_back(content_);
      redo_.pop_back();
      break;
  }
  content_ = entry.of.value_or(entry.revision.number);
  entries_.push_back(std::move(entry));
}

/// Takes one line of the file. Returns what is wrong with it, if anything is.
std::optional<std::string> EditJournal::read_line(const std::string& line) {
  const Json json = Json::parse(line, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return "the line is damaged: it is not a JSON object";
  JournalMembers members(json);
  if (is_empty() && members.count("journal") != kJournalFormat) {
    return "the file is not a journal of edits, or is one of a newer marey";
  }
  Entry entry;
  entry.revision = revision_in(members);
  if (members.has("of")) {
    entry.of = static_cast<int>(members.count("of"));
  } else {
    const std::string before = is_empty() ? std::string() : newest_text();
    const std::size_t keep = members.count("keep");
    const std::size_t drop = members.count("drop");
    const std::string added = members.text("text");
    if (keep > before.size() || drop > before.size() - keep) members.is_good = false;
    if (members.is_good) {
      entry.text = before.substr(0, keep) + added + before.substr(keep + drop);
    }
  }
  if (!members.is_good) {
    return "the line is damaged: a member is missing or of another type";
  }
  if (!follows(entry)) return "the line is damaged: it does not follow the one before it";
  const std::string& whole = entry.of ? text(*entry.of) : entry.text;
  if (recordings::sha256(whole) != entry.revision.sha256) {
    return "the line is damaged: its recipe has another SHA-256";
  }
  take(std::move(entry));
  return std::nullopt;
}

/// Writes an entry and takes it.
Status EditJournal::append(Entry entry, const std::string& text) {
  EditRevision& revision = entry.revision;
  revision.number = revision_count() + 1;
  revision.parent = revision_count();
  revision.sha256 = recordings::sha256(text);
  revision.time = utc_now();
  Json line;
  if (is_empty()) line["journal"] = kJournalFormat;
  line["revision"] = revision.number;
  line["parent"] = revision.parent;
  line["cause"] = std::string(name(revision.cause));
  line["sha256"] = revision.sha256;
  line["time"] = revision.time;
  if (entry.of) {
    line["of"] = *entry.of;
  } else {
    const std::string before = is_empty() ? std::string() : newest_text();
    const TextChange change = change_between(before, entry.text);
    line["keep"] = change.keep;
    line["drop"] = change.drop;
    line["text"] = std::string(change.text);
  }
  MAREY_ASSERT(follows(entry));
  const std::string bytes = line.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (const Status ok = lines_.append(bytes); !ok) return ok;
  take(std::move(entry));
  return Done{};
}

Status EditJournal::add(EditCause cause, std::string_view text) {
  Entry entry;
  entry.revision.cause = cause;
  entry.text = std::string(text);
  const std::string whole = entry.text;
  return append(std::move(entry), whole);
}

Status EditJournal::undo() {
  MAREY_ASSERT(can_undo());
  Entry entry;
  entry.revision.cause = EditCause::kUndo;
  entry.of = undo_.back();
  return append(std::move(entry), text(undo_.back()));
}

Status EditJournal::redo() {
  MAREY_ASSERT(can_redo());
  Entry entry;
  entry.revision.cause = EditCause::kRedo;
  entry.of = redo_.back();
  return append(std::move(entry), text(redo_.back()));
}

}  // namespace marey::app
