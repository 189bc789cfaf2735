// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <mutex>
#include <utility>

#include "recordings/base/sqlite.h"
#include "recordings/takes/take_file.h"
#include "recordings/takes/take_schema.h"

namespace marey::recordings {

struct TakeWriter::Impl {
  struct Row {
    int camera = 0;
    TakeFrame frame;
  };

  std::string file;
  Database database;
  Statement insert_frame;
  Statement insert_event;
  std::vector<std::int64_t> numbers;  ///< Number of each camera's next frame.
  std::mutex mutex;
  std::vector<Row> rows;          ///< Not committed yet; under the mutex.
  std::vector<TakeEvent> events;  ///< Not committed yet; under the mutex.
  std::vector<Row> writing_rows;  ///< Used by commit() only.
  std::vector<TakeEvent> writing_events;

  Impl(std::string name, Database opened, std::size_t cameras)
      : file(std::move(name)),
        database(std::move(opened)),
        insert_frame(database.get(), "INSERT INTO frame VALUES(?,?,?,?,?,?,?)"),
        insert_event(database.get(), "INSERT INTO event VALUES(?,?,?)"),
        numbers(cameras, 0) {}

  [[nodiscard]] Error error(const std::string& what) const {
    return disk_error(file, database.get(), what);
  }

  [[nodiscard]] bool write(const Row& row) {
    const TakeFrame& frame = row.frame;
    std::int64_t& number = numbers[static_cast<std::size_t>(row.camera)];
    insert_frame.bind(0, std::int64_t{row.camera});
    insert_frame.bind(1, number);
    insert_frame.bind(2, std::int64_t{frame.time.count()});
    insert_frame.bind(3, std::int64_t{frame.sequence});
    insert_frame.bind(4, std::int64_t{frame.dropped_before});
    insert_frame.bind(5, std::int64_t{frame.time_is_arrival ? 1 : 0});
    insert_frame.bind(6, std::int64_t{frame.damaged ? 1 : 0});
    if (!insert_frame.run()) return false;
    ++number;
    return true;
  }

  [[nodiscard]] bool write(const TakeEvent& event) {
    insert_event.bind(0, std::int64_t{event.camera});
    insert_event.bind(1, std::int64_t{event.time.count()});
    insert_event.bind(2, std::string_view(event.text));
    return insert_event.run();
  }
};

namespace {

bool write_head(sqlite3* database, const Take& take) {
  Statement head(database, "INSERT INTO take VALUES(?,?,0)");
  head.bind(0, std::string_view(take.trial));
  head.bind(1, std::string_view(take.started));
  if (!head.run()) return false;
  Statement camera(database, "INSERT INTO camera VALUES(?,?,?,?,?,?,?,?)");
  for (std::size_t c = 0; c < take.cameras.size(); ++c) {
    const TakeCamera& one = take.cameras[c];
    camera.bind(0, static_cast<std::int64_t>(c));
    camera.bind(1, std::string_view(one.name));
    camera.bind(2, std::string_view(one.file));
    camera.bind(3, std::int64_t{one.width_px});
    camera.bind(4, std::int64_t{one.height_px});
    camera.bind(5, one.rate.hz);
    camera.bind(6, std::string_view(one.device));
    camera.bind(7, std::string_view(one.settings));
    if (!camera.run()) return false;
  }
  return true;
}

}  // namespace

TakeWriter::TakeWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TakeWriter::TakeWriter(TakeWriter&&) noexcept = default;
TakeWriter& TakeWriter::operator=(TakeWriter&&) noexcept = default;
TakeWriter::~TakeWriter() = default;

Result<TakeWriter> TakeWriter::create(const std::filesystem::path& path,
                                      const Take& take) {
  auto database =
      begin_recorded(path,
                     {kTakeApplication, kTakeVersion, kTakeSchema},
                     "record under another trial's name, or move the old one away",
                     [&take](sqlite3* raw) { return write_head(raw, take); });
  if (!database) return database.error();
  // Created only now, because the statements need their tables.
  return TakeWriter(
      std::make_unique<Impl>(path.string(), *std::move(database), take.cameras.size()));
}

void TakeWriter::add(int camera, const TakeFrame& frame) {
  MAREY_ASSERT(camera >= 0 && static_cast<std::size_t>(camera) < impl_->numbers.size());
  const std::lock_guard lock(impl_->mutex);
  impl_->rows.push_back({camera, frame});
}

void TakeWriter::note(const TakeEvent& event) {
  const std::lock_guard lock(impl_->mutex);
  impl_->events.push_back(event);
}

Status TakeWriter::commit() {
  Impl& impl = *impl_;
  {
    const std::lock_guard lock(impl.mutex);
    impl.writing_rows.swap(impl.rows);
    impl.writing_events.swap(impl.events);
  }
  if (impl.writing_rows.empty() && impl.writing_events.empty()) return Done{};
  bool ok = execute(impl.database.get(), "BEGIN");
  for (const Impl::Row& row : impl.writing_rows) ok = ok && impl.write(row);
  for (const TakeEvent& event : impl.writing_events) ok = ok && impl.write(event);
  ok = ok && execute(impl.database.get(), "COMMIT");
  impl.writing_rows.clear();
  impl.writing_events.clear();
  if (ok) return Done{};
  const Error error = impl.error("frame times cannot be written");
  (void)execute(impl.database.get(), "ROLLBACK");
  return error;
}

Status TakeWriter::finish() {
  if (Status ok = commit(); !ok) return ok;
  // A single file is copied completely; a separate log could be forgotten by the user.
  if (execute(impl_->database.get(),
              "UPDATE take SET finished=1; PRAGMA journal_mode=DELETE")) {
    return Done{};
  }
  return impl_->error("the take cannot be completed");
}

}  // namespace marey::recordings
