// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/version.h"
#include "capture/detect_tags.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

/// Memory that the system would still give, in mebibytes; 0 where it does not say.
long available_memory_mib() {
  std::ifstream in("/proc/meminfo");
  std::string key;
  long kib = 0;
  std::string unit;
  while (in >> key >> kib >> unit) {
    if (key == "MemAvailable:") return kib / 1024;
  }
  return 0;
}

bool can_write_here() {
  std::error_code failed;
  const auto here = std::filesystem::current_path(failed);
  if (failed) return false;
  const auto probe = here / ".marey-doctor.partial";
  const bool ok = std::ofstream(probe).put('x').flush().good();
  std::filesystem::remove(probe, failed);
  return ok;
}

struct Check {
  std::string name;
  bool good = false;
  std::string finding;
  std::string advice;  ///< When not good.
};

std::vector<Check> examine() {
  const unsigned cores = std::thread::hardware_concurrency();
  const long memory_mib = available_memory_mib();
  std::vector<Check> checks;
  checks.push_back({"processor",
                    cores >= 2,
                    std::to_string(cores) + " cores",
                    "two cores or more keep up with four cameras"});
  checks.push_back({"memory",
                    memory_mib >= 1500,
                    std::to_string(memory_mib) + " MiB available",
                    "close other programs: a session needs up to 1.5 GB"});
  checks.push_back({"working folder",
                    can_write_here(),
                    can_write_here() ? "can be written to" : "cannot be written to",
                    "run marey in a folder of yours, or give --out one"});
  const bool detector = capture::TagDetector::create().has_value();
  checks.push_back({"tag detector",
                    detector,
                    detector ? "tag36h11 ready" : "cannot be started",
                    "install libapriltag3"});
  return checks;
}

}  // namespace

Exit run_doctor(bool json, Console& console) {
  const std::vector<Check> checks = examine();
  bool all_good = true;
  Json list = Json::array();
  for (const Check& check : checks) {
    all_good &= check.good;
    list.push_back(
        {{"check", check.name}, {"good", check.good}, {"finding", check.finding}});
    if (!check.good) list.back()["advice"] = check.advice;
  }
  if (json) {
    const Json out{{"version", kVersion}, {"good", all_good}, {"checks", list}};
    std::printf("%s\n", out.dump(2).c_str());
  } else {
    std::printf("marey %s\n", kVersion);
    for (const Check& check : checks) {
      std::printf("%-5s %-16s %s%s\n",
                  check.good ? "ok" : "poor",
                  check.name.c_str(),
                  check.finding.c_str(),
                  check.good ? "" : (": " + check.advice).c_str());
    }
  }
  if (!all_good) console.warn("this machine may not be enough: see above");
  return all_good ? Exit::kOk : Exit::kDevice;
}

}  // namespace marey::app
