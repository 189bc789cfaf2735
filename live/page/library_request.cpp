// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/library_request.h"

#include <algorithm>
#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/base/hex_digits.h"
#include "live/page/request_members.h"

namespace marey::live {
namespace {

constexpr std::size_t kMaxLibraryBytes = 16 * 1024;
constexpr std::size_t kMaxLibraryIdBytes = 64;
constexpr std::size_t kMaxQueryBytes = 4000;
constexpr std::size_t kMaxWordBytes = 200;
constexpr std::size_t kMaxNoteBytes = 500;
constexpr int kMaxRows = 500;
constexpr std::size_t kMaxDrawings = 64;

Error refused_library(std::string cause) {
  return bad_input("message from the page", std::move(cause), "reload the page");
}

/// Returns the value of a member's word; the first one and an error for another word.
template <class T, std::size_t N>
T word_of(RequestMembers& members,
          const char* member,
          const std::array<std::pair<std::string_view, T>, N>& words) {
  const std::string word = members.text(member, kMaxWordBytes);
  const auto found =
      std::ranges::find_if(words, [&](const auto& one) { return one.first == word; });
  if (found != words.end()) return found->second;
  members.fail(member, "one of the words of the protocol");
  return words.front().second;
}

constexpr std::array<std::pair<std::string_view, Verdict>, 3> kVerdicts{
    {{"pass", Verdict::kPass}, {"warn", Verdict::kWarn}, {"fail", Verdict::kFail}}};

constexpr std::array<std::pair<std::string_view, LibrarySort>, 6> kSorts{
    {{"number", LibrarySort::kNumber},
     {"name", LibrarySort::kName},
     {"seconds", LibrarySort::kSeconds},
     {"rate_hz", LibrarySort::kRate},
     {"quality", LibrarySort::kQuality},
     {"licence", LibrarySort::kLicence}}};

/// Reads a text that is stored in a table, without blanks around it. `is_needed`: it may
/// not be empty.
std::string stored_text(RequestMembers& members,
                        const char* member,
                        std::size_t max_bytes,
                        bool is_needed) {
  std::string text = members.text(member, max_bytes);
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  text.erase(text.find_last_not_of(' ') + 1);
  const bool has_control = std::ranges::any_of(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
  if (has_control) members.fail(member, "without control characters");
  if (is_needed && text.empty()) members.fail(member, "a text of a permitted length");
  return text;
}

/// Reads an id of a clip: 16 hexadecimal digits.
std::string clip_id_of_request(RequestMembers& members) {
  std::string id = members.text("clip_id", kMaxLibraryIdBytes);
  if (!is_hex(id, 16)) members.fail("clip_id", "the id of a clip");
  return id;
}

LibraryListRequest list_of(RequestMembers& members) {
  LibraryListRequest out;
  out.offset = members.count("offset");
  out.count = members.count("count");
  if (out.count < 1 || out.count > kMaxRows) members.fail("count", "from 1 to 500");
  out.query = members.text("query", kMaxQueryBytes);
  const auto* quality = members.find("quality");
  if (quality != nullptr && !quality->is_null()) {
    out.quality = word_of(members, "quality", kVerdicts);
  }
  out.sort = word_of(members, "sort", kSorts);
  out.is_descending = members.flag("descending");
  return out;
}

LibraryPosesRequest poses_of(RequestMembers& members) {
  LibraryPosesRequest out;
  const auto* clips = members.require("clips");
  if (clips == nullptr) return out;
  if (!clips->is_array() || clips->empty() || clips->size() > kMaxDrawings) {
    members.fail("clips", "a list of 1 to 64 numbers of clips");
    return out;
  }
  for (const nlohmann::json& clip : *clips) {
    out.clips.push_back(members.count_of(clip, "clips"));
  }
  return out;
}

LibraryVerdictRequest verdict_of(RequestMembers& members) {
  LibraryVerdictRequest out;
  out.clip_id = clip_id_of_request(members);
  out.figure = stored_text(members, "figure", kMaxWordBytes, true);
  out.frames = members.optional_span("frames");
  out.verdict = word_of(members, "verdict", kVerdicts);
  out.by = stored_text(members, "by", kMaxWordBytes, true);
  out.note = stored_text(members, "note", kMaxNoteBytes, false);
  return out;
}

LibraryLabelRequest label_of(RequestMembers& members) {
  LibraryLabelRequest out;
  out.clip_id = clip_id_of_request(members);
  out.start_s = members.seconds("start_s");
  out.end_s = members.seconds("end_s");
  if (out.end_s < out.start_s) members.fail("end_s", "at or after start_s");
  out.label = stored_text(members, "label", kMaxWordBytes, true);
  out.by = stored_text(members, "by", kMaxWordBytes, true);
  out.is_sure = members.flag("sure");
  return out;
}

/// Reads the members of all types but `hello`. Returns false if the type is unknown.
bool read_library_body(RequestMembers& members, LibraryPageRequest& out) {
  const std::string& type = out.type;
  if (type == "list") {
    out.body = list_of(members);
  } else if (type == "poses") {
    out.body = poses_of(members);
  } else if (type == "clip") {
    LibraryClipRequest clip;
    clip.clip = members.count("clip");
    clip.is_mirrored = members.flag("mirrored");
    out.body = clip;
  } else if (type == "verdict") {
    out.body = verdict_of(members);
  } else if (type == "label") {
    out.body = label_of(members);
  } else {
    return false;
  }
  out.revision = members.count("revision");
  out.id = members.text("id", kMaxLibraryIdBytes);
  return true;
}

}  // namespace

Result<LibraryPageRequest> read_library_request(std::string_view text) {
  if (text.size() > kMaxLibraryBytes) return refused_library("it is larger than 16 kB");
  const auto message = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!message.is_object()) return refused_library("it is not a JSON object");
  RequestMembers members(message);
  LibraryPageRequest out;
  out.type = members.text("type", kMaxLibraryIdBytes);
  if (out.type == "hello") {
    const auto hello = read_page_request(text);
    if (!hello) return hello.error();
    return out;
  }
  const bool is_known = read_library_body(members, out);
  if (members.cause().empty() && !is_known) {
    return refused_library("its type is unknown");
  }
  members.finish();
  if (!members.cause().empty()) return refused_library(members.cause());
  return out;
}

}  // namespace marey::live
