// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/base/input_file.h"

#include <system_error>

namespace marey {
namespace {

namespace fs = std::filesystem;

const char* kind_of(fs::file_type type) {
  switch (type) {
    case fs::file_type::fifo:
      return "pipe";
    case fs::file_type::character:
    case fs::file_type::block:
      return "device";
    case fs::file_type::socket:
      return "socket";
    default:
      return "special file";
  }
}

}  // namespace

Status check_input_file(const fs::path& path, const std::string& name) {
  const std::string where = name.empty() ? path.string() : name;
  std::error_code problem;
  const fs::file_status status = fs::status(path, problem);
  if (status.type() == fs::file_type::none) {
    return bad_input(where,
                     "the file cannot be read: " + problem.message(),
                     "check the name and its folder's permissions");
  }
  if (!fs::exists(status)) {
    return bad_input(where, "the file does not exist", "check the name and the folder");
  }
  if (fs::is_directory(status)) {
    return bad_input(where, "this is a folder, not a file", "name a file in it");
  }
  if (!fs::is_regular_file(status)) {
    return bad_input(where,
                     std::string("this is a ") + kind_of(status.type()) + ", not a file",
                     "write its data to a file, and use that file");
  }
  return Done{};
}

}  // namespace marey
