// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Part of measure_sessions: the table.
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <map>
#include <sstream>

#include "benchmarks/sessions/session_rows.h"
#include "core/base/quantile.h"

namespace marey::benchmarks {
namespace {

using testing::Tally;
using Rows = std::vector<SessionRow>;

std::size_t count_if(const Rows& rows, const std::function<bool(const SessionRow&)>& is) {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), is));
}

void print_outcomes(const char* what, const Rows& rows) {
  if (rows.empty()) return;
  const auto refused = [](const SessionRow& r) { return r.verdict.is_refused; };
  const auto wrongly = [](const SessionRow& r) {
    return r.verdict.is_refused && r.is_sufficient;
  };
  const auto wrong = [](const SessionRow& r) { return r.verdict.is_silently_wrong; };
  const auto sufficient = [](const SessionRow& r) { return r.is_sufficient; };
  const auto wrong_and_sufficient = [](const SessionRow& r) {
    return r.verdict.is_silently_wrong && r.is_sufficient;
  };
  const auto partial = [](const SessionRow& r) { return r.verdict.is_partial; };
  std::printf("%-22s %8zu %10zu %14zu %16zu %8zu %20zu %20zu\n",
              what,
              rows.size(),
              count_if(rows, sufficient),
              count_if(rows, wrong),
              count_if(rows, wrong_and_sufficient),
              count_if(rows, refused),
              count_if(rows, wrongly),
              count_if(rows, partial));
}

Rows some(const Rows& rows, const std::function<bool(const SessionRow&)>& is) {
  Rows out;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(out), is);
  return out;
}

bool has(const SessionRow& row, const char* words) {
  return row.session.find(words) != std::string::npos;
}

void print_all_outcomes(const Rows& rows) {
  std::printf("%-22s %8s %10s %14s %16s %8s %20s %20s\n",
              "sessions",
              "number",
              "sufficient",
              "silently wrong",
              "of sufficient",
              "refused",
              "though sufficient",
              "without hand or foot");
  print_outcomes("all", rows);
  for (const int cameras : {2, 3, 4, 5, 6}) {
    print_outcomes((std::to_string(cameras) + " cameras").c_str(),
                   some(rows, [&](const SessionRow& r) { return r.cameras == cameras; }));
  }
  // Words of SimulatedSession::summary(), and their meanings.
  constexpr std::array<std::array<const char*, 2>, 14> kParts{
      {{"(ring", "all around"},
       {"(arc", "in an arc"},
       {"up to 1 a", "1 tag a segment"},
       {"up to 2 a", "1 to 2 tags"},
       {"up to 3 a", "1 to 3 tags"},
       {"; range of motion", "good exercise"},
       {"; lazy range", "lazy exercise"},
       {"slide 0.0", "firm skin"},
       {"T pose", "T pose"},
       {"A pose", "A pose"},
       {"walk", "walk"},
       {"reach", "reach"},
       {"squat", "squat"},
       {"arm swings", "arm swings"}}};
  for (const auto& [words, meaning] : kParts) {
    print_outcomes(meaning,
                   some(rows, [&, w = words](const SessionRow& r) { return has(r, w); }));
  }
}

void print_shares(const Rows& rows) {
  std::printf("\njoint centres inside their 95 %% region, %% (number)\n%-10s", "");
  for (const char* joint :
       {"shoulder", "elbow", "wrist", "hip", "knee", "ankle", "together"}) {
    std::printf(" %16s", joint);
  }
  std::printf("\n");
  constexpr std::array<const char*, testing::kSources> kSourceNames{
      "measured", "repaired", "inferred"};
  for (std::size_t source = 0; source < testing::kSources; ++source) {
    std::array<Tally, testing::kJointKinds + 1> sums{};
    for (const SessionRow& row : rows) {
      for (std::size_t joint = 0; joint < testing::kJointKinds; ++joint) {
        const Tally& tally = row.verdict.honest[source][joint];
        for (const std::size_t to : {joint, sums.size() - 1}) {
          sums[to].count += tally.count;
          sums[to].inside += tally.inside;
        }
      }
    }
    std::printf("%-10s", kSourceNames[source]);
    for (const Tally& sum : sums) {
      std::printf(" %6.1f (%7d)", 100.0 * sum.inside / std::max(1, sum.count), sum.count);
    }
    std::printf("\n");
  }
}

void print_quantiles(const char* what,
                     const Rows& rows,
                     double factor,
                     const std::function<double(const SessionRow&)>& value) {
  std::vector<double> values;
  for (const SessionRow& row : rows) values.push_back(factor * value(row));
  if (values.empty()) return;
  std::printf("%-44s %8.2f %8.2f %8.2f\n",
              what,
              quantile(values, 0.5),
              quantile(values, 0.95),
              quantile(values, 1.0));
}

void print_figures(const Rows& rows) {
  const Rows accepted =
      some(rows, [](const SessionRow& r) { return !r.verdict.is_refused; });
  std::printf("\n%-44s %8s %8s %8s\n", "over sessions", "median", "95 %", "worst");
  print_quantiles(
      "median of measured joint centres, mm", accepted, 1e3, [](const auto& r) {
        return r.verdict.median_m;
      });
  print_quantiles("95 % of measured joint centres, mm", accepted, 1e3, [](const auto& r) {
    return r.verdict.p95_m;
  });
  print_quantiles("worst limb segment's length, % off", accepted, 1e2, [](const auto& r) {
    return r.verdict.worst_length_share;
  });
  print_quantiles("subject fit, s", rows, 1.0, [](const auto& r) { return r.fit_s; });
  print_quantiles("motion, s", accepted, 1.0, [](const auto& r) { return r.solve_s; });
  Tally lengths;
  int spikes = 0;
  int flips = 0;
  for (const SessionRow& row : accepted) {
    lengths.count += row.verdict.lengths.count;
    lengths.inside += row.verdict.lengths.inside;
    spikes += row.verdict.spike_frames;
    flips += row.verdict.flipped_frames;
  }
  std::printf("lengths of limb segments inside 1.96 sigma: %.1f %% of %d\n",
              100.0 * lengths.inside / std::max(1, lengths.count),
              lengths.count);
  std::printf("single gross frames (spikes): %d; segments flipped in a frame: %d\n",
              spikes,
              flips);
}

void print_counts(const char* title, const std::map<std::string, int>& counts) {
  std::printf("\n%s\n", title);
  std::vector<std::pair<int, std::string>> sorted;
  for (const auto& [what, count] : counts) sorted.emplace_back(-count, what);
  std::sort(sorted.begin(), sorted.end());
  for (const auto& [count, what] : sorted) std::printf("%6d  %s\n", -count, what.c_str());
}

void print_causes(const Rows& rows) {
  std::map<std::string, int> gross;
  std::map<std::string, int> messages;
  std::map<std::string, int> wrongly;
  std::map<std::string, int> left_out;
  for (const SessionRow& row : rows) {
    std::istringstream causes(row.causes);
    std::string cause;
    while (causes >> cause) ++gross[cause];
    std::istringstream segments(row.left_out);
    std::string segment;
    while (!row.verdict.is_refused && segments >> segment) ++left_out[segment];
    if (!row.verdict.is_refused) continue;
    const std::string message = row.refused_by + ": " + row.message_class;
    ++messages[message];
    if (row.is_sufficient) ++wrongly[message];
  }
  print_counts("persistent gross errors by joint and cause", gross);
  print_counts("segments left out of accepted sessions", left_out);
  print_counts("refusals by message", messages);
  print_counts("refusals of sufficient sessions by message", wrongly);
}

void print_seeds(const char* what,
                 const Rows& rows,
                 const std::function<bool(const SessionRow&)>& is) {
  std::printf("\n%s:", what);
  for (const SessionRow& row : rows) {
    if (is(row)) std::printf(" %llu", static_cast<unsigned long long>(row.seed));
  }
  std::printf("\n");
}

}  // namespace

void print_table(const Rows& rows) {
  print_all_outcomes(rows);
  print_shares(rows);
  print_figures(rows);
  print_causes(rows);
  print_seeds("silently wrong", rows, [](const SessionRow& r) {
    return r.verdict.is_silently_wrong;
  });
  print_seeds("refused though sufficient", rows, [](const SessionRow& r) {
    return r.verdict.is_refused && r.is_sufficient;
  });
}

}  // namespace marey::benchmarks
