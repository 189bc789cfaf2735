// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "edit/render.h"
#include <nlohmann/json_fwd.hpp>

#include "app/edit/edit_ghost.h"
#include "app/edit/edit_outputs.h"
#include "core/base/frame_range.h"
#include "core/finding.h"

namespace marey::app {

// Members of the message `rendered` (docs/formats/edit_page.md).

[[nodiscard]] nlohmann::ordered_json page_finding_json(const Finding& finding);
[[nodiscard]] nlohmann::ordered_json page_findings_json(
    const std::vector<Finding>& findings);
[[nodiscard]] nlohmann::ordered_json op_report_json(const edit::OpReport& report);

/// One output and the parts of it that are sent.
struct SentOutput {
  const edit::EditState& state;
  std::string name;
  FrameRange span;
  std::string block;  ///< Path.
  std::vector<EditGraph> graphs;
  std::optional<EditFigures> figures{};
};
[[nodiscard]] nlohmann::ordered_json output_json(const SentOutput& output);

}  // namespace marey::app
