// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "recordings/library/label_file.h"

namespace marey::recordings {

/// Labels of a file of BABEL.
struct BabelLabels {
  std::vector<LabelRow> rows;  ///< In the order of the file's sequences by name.
  /// Labels without text, or that end before they start.
  int left_out = 0;
};

/// Reads the labels of BABEL (Punnakkal et al. 2021, https://babel.is.tue.mpg.de): a JSON
/// object of sequences, each with `feat_p`, the path of its motion in AMASS. Labels of
/// the whole sequence (`seq_ann`) have no times, those of parts (`frame_ann`) have
/// `start_t` and `end_t` in seconds. `seq_anns` and `frame_anns` are lists of the same,
/// by several people. Each `proc_label` (`raw_label` if it is missing) is a label, and so
/// is each category in `act_cat`, as "act_cat:CATEGORY". Equal labels of a sequence occur
/// once.
///
/// The target of a row is `feat_p`; `by` is its author. Errors (kBadInput), with the
/// sequence: not JSON; more than 256 MiB; a value of another type; no `feat_p`.
/// Linear, but for sorting.
[[nodiscard]] Result<BabelLabels> parse_babel(std::string_view text,
                                              const std::string& file,
                                              const std::string& by);

/// Applies parse_babel() to the file at `path`.
[[nodiscard]] Result<BabelLabels> read_babel(const std::filesystem::path& path,
                                             const std::string& by);

}  // namespace marey::recordings
