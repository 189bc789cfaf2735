// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <mutex>
#include <utility>

#include "recordings/base/sqlite.h"
#include "recordings/takes/live_take.h"
#include "recordings/takes/live_take_schema.h"
#include "recordings/takes/view_bytes.h"

namespace marey::recordings {
namespace {

bool write_head(sqlite3* database, const LiveTakeHead& head) {
  Statement live(database, "INSERT INTO live VALUES(?,?,?,?,0)");
  live.bind(0, std::string_view(head.session));
  live.bind(1, std::string_view(head.started));
  live.bind(2, head.rate.hz);
  live.bind(3, std::string_view(head.settings));
  if (!live.run()) return false;
  Statement camera(database, "INSERT INTO camera VALUES(?,?)");
  for (std::size_t c = 0; c < head.cameras.size(); ++c) {
    camera.bind(0, static_cast<std::int64_t>(c));
    camera.bind(1, std::string_view(head.cameras[c]));
    if (!camera.run()) return false;
  }
  return true;
}

}  // namespace

struct LiveTakeWriter::Impl {
  std::string file;
  Database database;
  Statement insert;
  std::mutex mutex;
  std::vector<LiveTakeInstant> added;    ///< Not committed yet; under the mutex.
  std::vector<LiveTakeInstant> writing;  ///< Used by commit() only.
  std::vector<std::byte> views;          ///< Used by commit() only.

  Impl(std::string name, Database opened)
      : file(std::move(name)),
        database(std::move(opened)),
        insert(database.get(), "INSERT INTO instant VALUES(?,?,?,?,?)") {}

  [[nodiscard]] bool write(const LiveTakeInstant& one) {
    write_views(one.seen.views, views);
    insert.bind(0, one.seen.number);
    insert.bind(1, std::int64_t{one.seen.time.count()});
    insert.bind(2, std::span<const std::byte>(views));
    insert.bind(3, std::string_view(one.requests));
    insert.bind(4, std::span<const std::byte>(one.results));
    return insert.run();
  }
};

LiveTakeWriter::LiveTakeWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LiveTakeWriter::LiveTakeWriter(LiveTakeWriter&&) noexcept = default;
LiveTakeWriter& LiveTakeWriter::operator=(LiveTakeWriter&&) noexcept = default;
LiveTakeWriter::~LiveTakeWriter() = default;

Result<LiveTakeWriter> LiveTakeWriter::create(const std::filesystem::path& path,
                                              const LiveTakeHead& head) {
  auto database =
      begin_recorded(path,
                     {kLiveTakeApplication, kLiveTakeVersion, kLiveTakeSchema},
                     "record into another folder, or move the old one away",
                     [&head](sqlite3* raw) { return write_head(raw, head); });
  if (!database) return database.error();
  // Created only now, because the statement needs its table.
  return LiveTakeWriter(std::make_unique<Impl>(path.string(), *std::move(database)));
}

Status LiveTakeWriter::add(const LiveTakeInstant& instant) {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->added.size() >= kMaxWaiting) {
    return Error{Errc::kDevice,
                 impl_->file,
                 "the disk has accepted no data for a long time",
                 "record to a faster disk"};
  }
  impl_->added.push_back(instant);
  return Done{};
}

Status LiveTakeWriter::commit() {
  Impl& impl = *impl_;
  {
    const std::lock_guard lock(impl.mutex);
    impl.writing.swap(impl.added);
  }
  if (impl.writing.empty()) return Done{};
  bool ok = execute(impl.database.get(), "BEGIN");
  for (const LiveTakeInstant& one : impl.writing) ok = ok && impl.write(one);
  ok = ok && execute(impl.database.get(), "COMMIT");
  impl.writing.clear();
  if (ok) return Done{};
  const Error error =
      disk_error(impl.file, impl.database.get(), "the live take cannot be written");
  (void)execute(impl.database.get(), "ROLLBACK");
  return error;
}

Status LiveTakeWriter::finish() {
  if (Status ok = commit(); !ok) return ok;
  // A single file is copied completely; a separate log could be forgotten by the user.
  if (execute(impl_->database.get(),
              "UPDATE live SET finished=1; PRAGMA journal_mode=DELETE")) {
    return Done{};
  }
  return disk_error(impl_->file, impl_->database.get(), "the take cannot be completed");
}

}  // namespace marey::recordings
