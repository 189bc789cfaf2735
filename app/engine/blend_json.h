// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/engine/blend_figures.h"

namespace marey::app {

/// Returns the output of `marey blend --json` (docs/formats/blend.md).
[[nodiscard]] nlohmann::ordered_json blend_json(const BlendArguments& args,
                                                const BlendInputs& inputs,
                                                const PlayedBlend& played,
                                                const BlendFigures& figures);

/// Returns the same figures as lines for a reader.
[[nodiscard]] std::vector<std::string> blend_lines(const BlendArguments& args,
                                                   const BlendInputs& inputs,
                                                   const BlendFigures& figures);

}  // namespace marey::app
