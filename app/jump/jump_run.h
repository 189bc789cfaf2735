// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/op_report.h"

#include "app/edit/edit_figures.h"
#include "app/edit/edit_run.h"
#include "app/jump/jump_options.h"
#include "app/motion/motion_files.h"
#include "app/shell/console.h"
#include "core/base/result.h"
#include "core/finding.h"

namespace marey::app {

/// A motion with a changed jump.
struct JumpRun {
  EditRun edit;         ///< One output, one report.
  EditFigures figures;  ///< Figures of the output, by forward kinematics.
  /// Findings of the readers and the operation; places name the motion's file or an
  /// option.
  std::vector<Finding> findings;

  [[nodiscard]] const edit::EditState& state() const {
    return edit.rendered.outputs.front();
  }
  [[nodiscard]] const edit::OpReport& report() const {
    return edit.rendered.reports.front();
  }
};

/// Returns the format of the result by its extension. Errors (bad input): no format of a
/// motion; the path is a folder, or a file that is read.
[[nodiscard]] Result<MotionFormat> check_jump_out(const JumpArguments& args);

/// Reads the motion, puts it on the character's body if there is one, and applies the
/// operation `jump`. Writes nothing.
/// Errors: those of read_edit_files(), make_adapt_body(), render() and
/// check_result_format(). An error of the operation names the motion's file and the
/// option.
[[nodiscard]] Result<JumpRun> run_jump_edit(const JumpArguments& args,
                                            MotionFormat format,
                                            Console& console);

}  // namespace marey::app
