// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/frame_range.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "live/page/page_request.h"

namespace marey::live {

// Messages of the page of a motion library to the server: docs/formats/library_page.md.

enum class LibrarySort { kNumber, kName, kSeconds, kRate, kQuality, kLicence };

/// Rows `offset` to `offset + count - 1` of the clips that fulfil a condition.
struct LibraryListRequest {
  int offset = 0;
  int count = 0;
  std::string query{};  ///< Expression of `marey library query`; empty: all.
  std::optional<Verdict> quality = std::nullopt;
  LibrarySort sort = LibrarySort::kNumber;
  bool is_descending = false;
};
/// Drawings of clips.
struct LibraryPosesRequest {
  std::vector<int> clips{};
};
/// A clip with its motion and the clips that are similar to it.
struct LibraryClipRequest {
  int clip = 0;
  bool is_mirrored = false;  ///< Searches for the mirror image of the clip.
};
/// A person's own verdict on a figure of a clip.
struct LibraryVerdictRequest {
  std::string clip_id{};
  std::string figure{};
  /// Part of the clip that the verdict is about; nullopt: all of it.
  std::optional<FrameRange> frames = std::nullopt;
  Verdict verdict = Verdict::kPass;
  std::string by{};
  std::string note{};
};
/// A name for a part of a clip.
struct LibraryLabelRequest {
  std::string clip_id{};
  double start_s = 0.0;
  double end_s = 0.0;
  std::string label{};
  std::string by{};
  bool is_sure = true;
};

struct LibraryPageRequest {
  std::string type{};  ///< "list", as in the message.
  std::string id{};    ///< Chosen by the page; may be empty.
  int revision = 0;    ///< Revision of the index that numbers of clips belong to.
  std::variant<HelloRequest,
               LibraryListRequest,
               LibraryPosesRequest,
               LibraryClipRequest,
               LibraryVerdictRequest,
               LibraryLabelRequest>
      body;
};

/// Parses one message. Linear in its bytes.
///
/// Errors (kBadInput), for the page: not a JSON object, an unknown type or member, a
/// member that is missing, of another type or out of bounds. Bounds: 16 kB, ids up to 64
/// bytes, 1 to 500 rows, 1 to 64 drawings, queries up to 4000 bytes, labels and names 1
/// to 200 bytes, notes up to 500 bytes, a label's end not before its start. Texts that
/// are stored have no control characters.
[[nodiscard]] Result<LibraryPageRequest> read_library_request(std::string_view text);

}  // namespace marey::live
