// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "app/library/build/source_outcome.h"
#include "app/library/sources/list_sources.h"
#include "core/base/result.h"

namespace marey::app {

/// Divides sources into shards of nearly equal bytes: the largest first, each into the
/// shard with the fewest bytes, the first one of equal ones. Deterministic. A shard's
/// sources are in descending order of bytes. Cost: sources times shards.
/// Precondition: shards >= 1.
[[nodiscard]] std::vector<std::vector<SourceFile>> divide_sources(
    std::vector<SourceFile> sources, int shards);

/// State of the work that `marey library plan` divided (LIB/shards/).
struct ShardPlan {
  /// SHA-256 of all inputs except the sources: library.toml, labels, tables.
  std::string inputs;
  int shards = 0;
  /// SHA-256 of the inputs and of all lists. The lists and the outcomes of the plan begin
  /// with it, so that those of an earlier plan are recognised.
  std::string id = {};
};

/// Writes the plan, with its id, and the list of each shard, shards/0001.todo. The plan
/// comes last, so that an interrupted one does not count. Errors: (kBadInput) the path of
/// a source is not UTF-8; (kDevice) the disk.
[[nodiscard]] Status write_shard_plan(const std::filesystem::path& library,
                                      const ShardPlan& plan,
                                      const std::vector<std::vector<SourceFile>>& lists);

/// Reads the plan. Errors (kBadInput): no plan; a damaged one.
[[nodiscard]] Result<ShardPlan> read_shard_plan(const std::filesystem::path& library);

/// Reads the sources of one shard, from 1. `source_count` is the number of [[source]] of
/// the library. Errors (kBadInput): no such shard; it is damaged, or of another plan.
[[nodiscard]] Result<std::vector<SourceFile>> read_shard_list(
    const std::filesystem::path& library,
    const ShardPlan& plan,
    int shard,
    std::size_t source_count);

/// Writes the outcomes of a shard, shards/0001.jsonl, whole or not at all. Errors
/// (kBadInput): another plan has replaced this one meanwhile.
[[nodiscard]] Status write_shard_outcomes(const std::filesystem::path& library,
                                          const ShardPlan& plan,
                                          int shard,
                                          const std::vector<SourceOutcome>& outcomes);

/// Reads the outcomes of a shard. Errors (kBadInput): it is not finished; damaged, or of
/// another plan.
[[nodiscard]] Result<std::vector<SourceOutcome>> read_shard_outcomes(
    const std::filesystem::path& library, const ShardPlan& plan, int shard);

/// Returns the numbers of the shards without outcomes, ascending.
[[nodiscard]] std::vector<int> unfinished_shards(const std::filesystem::path& library,
                                                 const ShardPlan& plan);

/// Removes the plan and everything in shards/ that these functions wrote; the plan first.
void remove_shards(const std::filesystem::path& library);

/// Returns a script of a POSIX shell that runs a plan with Slurm: an array of one task
/// per shard, and the merge after them, also if some failed. `program` and `library` are
/// absolute paths.
[[nodiscard]] std::string slurm_script(const std::string& program,
                                       const std::filesystem::path& library,
                                       int shards);

}  // namespace marey::app
