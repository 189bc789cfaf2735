// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the memory of a member of a crowd: live bytes of operator new, as requested.
//
//   measure_member_memory
//
// Bodies have 22 bones; constraints are two supports and two targets of the wrists. Rows:
// a single adapter, and a crowd of 1000 with equal and with different bodies, each
// without and with balance. The second table lists the bytes of the parts that an adapter
// is made from, as if each were held once per member.
#include <cstdio>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#include <malloc.h>

#include "benchmarks/adaptation/members/member_scene.h"
#include "retarget/adapt/kernel/adapt_lanes.h"
#include "retarget/adapt/kernel/thesis_solve.h"
#include "retarget/adapt/plan/adapt_numbers.h"
#include "retarget/adapt/plan/adapt_plan.h"
#include "retarget/constraints/activation.h"

namespace {
long long live_bytes = 0;
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  live_bytes += static_cast<long long>(malloc_usable_size(memory));
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t align) {
  const auto step = static_cast<std::size_t>(align);
  void* memory = std::aligned_alloc(step, (size + step - 1) / step * step);
  if (memory == nullptr) throw std::bad_alloc();
  live_bytes += static_cast<long long>(malloc_usable_size(memory));
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  if (memory != nullptr) live_bytes -= static_cast<long long>(malloc_usable_size(memory));
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  operator delete(memory);
}
[[gnu::noinline]] void operator delete(void* memory,
                                       std::size_t,
                                       std::align_val_t) noexcept {
  operator delete(memory);
}

namespace marey {
namespace {

constexpr std::size_t kMembers = 1000;
constexpr double kKiB = 1024.0;

/// Returns the bytes that the object made by `make` holds, itself included.
template <class Make>
double bytes_of(const Make& make) {
  const long long before = live_bytes;
  auto object = make();
  return static_cast<double>(live_bytes - before) + sizeof(object);
}

void print_members(const std::vector<SceneMember>& alike,
                   const std::vector<SceneMember>& different) {
  std::printf("%-12s %12s %16s %16s %16s\n",
              "balance",
              "adapter KiB",
              "1000 equal KiB",
              "1000 other KiB",
              "of 1 member KiB");
  for (const auto balance :
       {retarget::BalanceMode::kOff, retarget::BalanceMode::kHorizontal}) {
    retarget::AdaptOptions options;
    options.balance = balance;
    const auto crowd_of = [&](const std::vector<SceneMember>& scene) {
      return bytes_of([&] { return make_members(scene, options); });
    };
    const double one = bytes_of([&] { return make_member(alike[0], options); });
    const double crowd_of_one = crowd_of({alike[0]});
    const auto each = [&](double crowd) { return crowd / kKiB / kMembers; };
    std::printf("%-12s %12.2f %16.2f %16.2f %16.2f\n",
                balance == retarget::BalanceMode::kOff ? "off" : "horizontal",
                one / kKiB,
                each(crowd_of(alike)),
                each(crowd_of(different)),
                crowd_of_one / kKiB);
  }
}

void print_parts(const SceneMember& member) {
  using namespace retarget;
  const Plan plan = make_plan(member.character, member.constraints, true);
  const auto row = [](const char* name, double bytes) {
    std::printf("%-36s %8.0f\n", name, bytes);
  };
  std::printf("\n%-36s %8s\n", "part", "bytes");
  row("character", bytes_of([&] { return member.character; }));
  row("constraints", bytes_of([&] { return member.constraints; }));
  row("plan", bytes_of([&] { return plan; }));
  row("order of the thesis' method", bytes_of([&] { return make_thesis_plan(plan); }));
  row("numbers of the body",
      bytes_of([&] { return body_numbers(member.character, plan); }));
  row("T-pose rotations", bytes_of([&] { return t_pose_rotations(member.character); }));
  row("work arrays of one lane", bytes_of([&] { return Lanes<float>(plan); }));
  const std::size_t n = plan.parent.size();
  const std::size_t count = member.constraints.constraints.size();
  row("world transforms", static_cast<double>(n * sizeof(RigidTransform)));
  row("activations", static_cast<double>(count * sizeof(LiveActivation)));
  row("outcomes and report",
      static_cast<double>(count * sizeof(ConstraintOutcome) + sizeof(AdaptReport)));
}

}  // namespace
}  // namespace marey

int main() {
  using marey::MemberTask;
  const auto alike = marey::make_scene(MemberTask::kTargets, marey::kMembers, true);
  const auto different = marey::make_scene(MemberTask::kTargets, marey::kMembers, false);
  marey::print_members(alike, different);
  marey::print_parts(alike[0]);
  return 0;
}
