// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/tag_family.h"
#include "recordings/session.h"
#include "recordings/toml_reader.h"

// Private to recordings.
namespace marey::recordings {

/// The family that a table's `family` names, or `usual` without that key. Mistake: a
/// family that marey does not read.
[[nodiscard]] KnownFamily read_family(TomlReader& reader, const KnownFamily& usual);

/// The family of tables that name none: tag36h11.
[[nodiscard]] KnownFamily usual_family();

/// Notes that a tag of this family is in use. With a single family all its tags are
/// welcome; of several, only those in use.
void use_tag(const KnownFamily& family, TagId id, Session& session);

}  // namespace marey::recordings
