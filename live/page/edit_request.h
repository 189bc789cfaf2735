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
#include "live/page/page_request.h"

namespace marey::live {

// Messages of the page of marey edit to the server: docs/formats/edit_page.md.

/// One step of a change of a recipe's operations. Indices are not negative; whether they
/// exist is decided where the recipe is known.
struct OpsPatchStep {
  enum class Kind { kInsert, kReplace, kRemove, kMove, kToggle };
  Kind kind = Kind::kRemove;
  int index = 0;
  int to = 0;        ///< For kMove.
  bool off = false;  ///< For kToggle.
  /// For kInsert and kReplace: "[[op]]" and its keys, as in a recipe. Its keys and values
  /// are unchecked: the reader of recipes checks them.
  std::string op_toml{};
};
using OpsPatch = std::vector<OpsPatchStep>;

/// Makes a revision.
struct EditRequest {
  int base_revision = 0;
  OpsPatch patch{};
};
struct UndoRequest {
  int base_revision = 0;
};
struct RedoRequest {
  int base_revision = 0;
};
/// Renders a change without making a revision; without steps, the revision itself.
struct PreviewRequest {
  int base_revision = 0;
  OpsPatch patch{};
  std::optional<int> until{};   ///< Number of operations; nullopt: all.
  std::optional<int> output{};  ///< Index; nullopt: all outputs.
  std::optional<FrameRange> span{};
};
struct LoopsRequest {
  int base_revision = 0;
  std::optional<int> until{};
  int output = 0;
  std::optional<double> min_period_s{};
  std::optional<double> max_period_s{};
  bool map = false;
};
/// Asks for the curves of an operation `jump`, of the revision or after a change that is
/// not made.
struct JumpRequest {
  int base_revision = 0;
  OpsPatch patch{};  ///< May be empty.
  int op = 0;        ///< Index of the operation after the patch.
  int output = 0;
};
struct ExportRequest {
  int base_revision = 0;
};

struct EditPageRequest {
  std::string type;  ///< "edit", as in the message.
  std::string id;    ///< Chosen by the page; may be empty.
  std::variant<HelloRequest,
               ShownRequest,
               EditRequest,
               UndoRequest,
               RedoRequest,
               PreviewRequest,
               LoopsRequest,
               JumpRequest,
               ExportRequest>
      body;
};

/// Parses one message. Linear in its bytes.
///
/// Errors (kBadInput), for the page: not a JSON object, an unknown type or member, a
/// member that is missing, of another type or out of bounds. Bounds: 16 kB, 1 to 64 steps
/// of a patch, ids up to 64 bytes, keys of an operation up to 64 letters, digits, "_" and
/// "-", six levels of lists and objects in it, no null.
[[nodiscard]] Result<EditPageRequest> read_edit_request(std::string_view text);

}  // namespace marey::live
