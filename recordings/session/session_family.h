// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/tag_family.h"
#include "recordings/base/toml_reader.h"
#include "recordings/session/session.h"

// Private to recordings.
namespace marey::recordings {

/// Reads the key `family` of a table; the default is `usual`. Mistake: a family that
/// marey does not support.
[[nodiscard]] KnownFamily read_family(TomlReader& reader, const KnownFamily& usual);

/// Returns the default family: tag36h11.
[[nodiscard]] KnownFamily default_family();

/// Marks a tag of this family as in use. With a single family all its tags are detected;
/// with several, only those in use.
void use_tag(const KnownFamily& family, TagId id, Session& session);

}  // namespace marey::recordings
