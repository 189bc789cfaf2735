// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings {

/// The kinds of marey's TOML files.
enum class TomlKind {
  kUnknown,
  kSession,
  kCalibration,
  kSubject,
  kPlan,
  kCharacter,
  kFloor,
  kBoneMap,
  kMarkerMap,
  kEditRecipe,
  kScene,
  kTrials,
};

/// Returns the kind of a document by its first keys; its reader checks the rest.
[[nodiscard]] TomlKind toml_kind(TomlDocument& document);

/// Returns the mistake that the readers found in a document, for the user: if the
/// document has more keys of another kind than of `wanted`, the file is of that kind; if
/// it has no keys, the file is empty. Takes the mistake out of the document.
/// Preconditions: `document.mistake`; `wanted` is not kUnknown.
[[nodiscard]] Error mistake_of(TomlDocument& document, TomlKind wanted);

}  // namespace marey::recordings
