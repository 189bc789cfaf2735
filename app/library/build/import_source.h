// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "app/library/build/build_inputs.h"
#include "app/library/build/source_cache.h"
#include "app/library/build/source_outcome.h"

namespace marey::app {

/// Returns the outcome of a source whose objects exist already; nullopt: they have to be
/// made. Cost: a look into the folder of objects.
[[nodiscard]] std::optional<SourceOutcome> find_outcome(const BuildInputs& inputs,
                                                        const SourceFile& file,
                                                        const std::string& source_id);

/// An outcome, and the source as it was when it was read.
struct ImportedSource {
  SourceOutcome outcome;
  std::optional<KnownSource> known;  ///< nullopt: it could not be identified.
};

/// Makes the objects of a source that do not exist: the motions of its bodies, each in
/// normal form with its floor at 0, then the records of its clips and their features.
/// Each object is whole or absent. Deterministic: depends on the source's content and the
/// settings only. The failure of a source is its outcome. It is remembered if the content
/// of the source is the cause.
[[nodiscard]] ImportedSource import_source(const BuildInputs& inputs,
                                           const SourceFile& file);

}  // namespace marey::app
