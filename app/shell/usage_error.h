// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <CLI/CLI.hpp>

#include "core/base/result.h"

namespace marey::app {

/// Returns the error of a command line that `app` refused with `problem`: a word that is
/// no command, an unknown option, a missing or superfluous argument, or a value that an
/// option does not take. The first of these that applies is the cause; the next step is
/// the nearest command or option, or the command that prints the help.
/// The cause has no text of the parser. Preconditions: `app` parsed `arguments`, with the
/// program's name first; `problem` is not a request for help or for the version.
[[nodiscard]] Error usage_error(const CLI::App& app,
                                const CLI::ParseError& problem,
                                std::span<const char* const> arguments);

}  // namespace marey::app
