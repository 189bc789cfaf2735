// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/program/run_program.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

/// Two temporary files for the program's standard output and standard error.
struct Ears {
  ScratchFolder folder;

  [[nodiscard]] fs::path out() const { return folder / "out"; }
  [[nodiscard]] fs::path err() const { return folder / "err"; }
};

void point_at(const char* file, int flags, int descriptor) {
  const int opened = open(file, flags, 0600);
  if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
  close(opened);
}

pid_t start(const fs::path& program,
            const std::vector<std::string>& arguments,
            const fs::path& folder,
            const Ears& ears) {
  // All memory is allocated before the fork.
  const std::string path = fs::absolute(program).string();
  const std::string out = ears.out().string();
  const std::string err = ears.err().string();
  std::vector<std::string> words{path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot start " + path);
  if (child > 0) return child;
  point_at("/dev/null", O_RDONLY, STDIN_FILENO);
  point_at(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, STDOUT_FILENO);
  point_at(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, STDERR_FILENO);
  if (!folder.empty() && chdir(folder.c_str()) != 0) _exit(126);
  execv(path.c_str(), argv.data());
  _exit(127);
}

int wait_for(pid_t child, const Ears& ears, const std::string& interrupt_at) {
  bool interrupted = interrupt_at.empty();
  for (int status = 0;;) {
    const pid_t ended = waitpid(child, &status, interrupted ? 0 : WNOHANG);
    if (ended == child) {
      return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    }
    if (ended < 0) throw std::runtime_error("waitpid() failed");
    if (read_text(ears.err()).find(interrupt_at) != std::string::npos) {
      kill(child, SIGINT);
      interrupted = true;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
}

}  // namespace

ProgramRun run_program(const fs::path& program,
                       const std::vector<std::string>& arguments,
                       const RunOptions& options) {
  const Ears ears;
  ProgramRun run;
  const pid_t child = start(program, arguments, options.folder, ears);
  run.exit_code = wait_for(child, ears, options.interrupt_at);
  run.out = read_text(ears.out());
  run.err = read_text(ears.err());
  if (run.exit_code == 127) {
    throw std::runtime_error("cannot start " + program.string());
  }
  return run;
}

}  // namespace marey::testing
