// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the time of a member of a crowd of 1000 different bodies with 22 bones.
//
//   measure_member_time [--rounds N]
//
// Rows: supports only, supports with targets of the wrists (20 % beyond reach), and
// supports that fade in 20 % or 100 % of the members, each without balance and with
// kHorizontal. "one by one" solves the same members with their own adapters. Times are
// microseconds of processor time per member, from Pose to Pose. The last column is a
// hash of all postures and reports of the crowd, which must not depend on the machine.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "benchmarks/adaptation/members/member_scene.h"
#include "benchmarks/adaptation/posture_measures.h"
#include "core/base/quantile.h"

namespace marey {
namespace {

constexpr std::size_t kMembers = 1000;

class Hash {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) hash_ = (hash_ ^ at[i]) * 1099511628211ULL;
  }
  template <class T>
  void add(const T& x) {
    add(&x, sizeof(T));
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

std::uint64_t hash_of(const std::vector<Pose>& poses,
                      const std::vector<retarget::AdaptReport>& reports) {
  Hash hash;
  for (const Pose& pose : poses) {
    hash.add(pose.root_in_world);
    for (const glm::dquat& q : pose.parent_from_joint) hash.add(q);
  }
  for (const retarget::AdaptReport& report : reports) {
    hash.add(report.iterations);
    hash.add(report.constraint_error_m);
    hash.add(report.worst_error_m);
    hash.add(report.balance_error_m);
  }
  return hash.value();
}

struct Times {
  std::vector<double> crowd_us;
  std::vector<double> alone_us;
};

/// A crowd and the same members with their own adapters.
class Row {
 public:
  Row(const char* name, MemberTask task, retarget::BalanceMode balance)
      : name_(name),
        balance_(balance),
        scene_(make_scene(task, kMembers, false)),
        crowd_(make_members(scene_, options(balance))),
        out_(kMembers),
        reports_(kMembers) {
    for (const SceneMember& member : scene_) {
      alone_.push_back(make_member(member, options(balance)));
      references_.push_back(member.reference);
    }
  }

  void run() {
    const double start_us = processor_us();
    crowd_.adapt(references_, kFadingTime_s, out_, reports_);
    const double end_us = processor_us();
    times_.crowd_us.push_back((end_us - start_us) / kMembers);
    Pose pose;
    const double start_alone_us = processor_us();
    for (std::size_t i = 0; i < kMembers; ++i) {
      static_cast<void>(alone_[i].adapt(references_[i], kFadingTime_s, pose));
    }
    times_.alone_us.push_back((processor_us() - start_alone_us) / kMembers);
  }

  void print() const {
    int iterations = 0;
    int limbs = 0;
    for (const retarget::AdaptReport& report : reports_) {
      iterations += report.iterations;
      if (report.iterations == 0) ++limbs;
    }
    std::printf("%-28s %-10s %8.3f %8.3f %10.3f %10.2f %7d %016llx\n",
                name_,
                balance_ == retarget::BalanceMode::kOff ? "off" : "horizontal",
                median(times_.crowd_us),
                quantile(times_.crowd_us, 0.0),
                median(times_.alone_us),
                static_cast<double>(iterations) / kMembers,
                limbs,
                static_cast<unsigned long long>(hash_of(out_, reports_)));
  }

 private:
  static retarget::AdaptOptions options(retarget::BalanceMode balance) {
    retarget::AdaptOptions out;
    out.balance = balance;
    return out;
  }

  const char* name_;
  retarget::BalanceMode balance_;
  std::vector<SceneMember> scene_;
  retarget::Crowd crowd_;
  std::vector<retarget::Adapter> alone_;
  std::vector<Pose> references_;
  std::vector<Pose> out_;
  std::vector<retarget::AdaptReport> reports_;
  Times times_;
};

void measure(int rounds) {
  std::vector<Row> rows;
  for (const auto balance :
       {retarget::BalanceMode::kOff, retarget::BalanceMode::kHorizontal}) {
    rows.emplace_back("supports", MemberTask::kSupports, balance);
    rows.emplace_back("supports, targets 20 % far", MemberTask::kTargets, balance);
    rows.emplace_back("supports, 20 % fade", MemberTask::kFading, balance);
    rows.emplace_back("supports, all fade", MemberTask::kAllFade, balance);
  }
  for (int round = 0; round < rounds; ++round) {
    for (Row& row : rows) row.run();
  }
  std::printf("%-28s %-10s %8s %8s %10s %10s %7s %16s\n",
              "members",
              "balance",
              "us",
              "best us",
              "one by one",
              "iterations",
              "0 iter.",
              "hash");
  for (const Row& row : rows) row.print();
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  int rounds = 15;
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::string_view(argv[i]) == "--rounds") rounds = std::atoi(argv[i + 1]);
  }
  if (rounds < 1) {
    std::fprintf(stderr, "--rounds must be at least 1\n");
    return 2;
  }
  marey::measure(rounds);
  return 0;
}
