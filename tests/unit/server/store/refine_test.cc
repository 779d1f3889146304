// The stage REFINE: rounds of blocks of points.
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "database/sqlite.h"
#include "expect_store_error.h"
#include "refine_fixture.h"
#include "wire/refined_record.h"

namespace affskel::server {
namespace {

TEST_F(RefineTest, AJobGoesThroughRoundsUntilOneFindsNothing) {
  const v1::Job job = erode_infimum();
  EXPECT_EQ(job.stage(), v1::JOB_STAGE_REFINE);
  EXPECT_EQ(job.refine_round(), 0U);
  EXPECT_EQ(job.refined_points(), 0U);
  const v1::Lease first = lease();
  EXPECT_EQ(first.kind(), v1::TASK_KIND_REFINE);
  report_points(first, 0, 100);
  EXPECT_EQ(store_->job(job.id()).refined_points(), 100U);
  report_points(first, 100, first.positions(0).end(), true);
  finish_rounds(job.id(), 3);
  EXPECT_EQ(store_->job(job.id()).refine_round(), 3U);
  EXPECT_THROW(refined(job.id()), StoreError);
  finish_rounds(job.id(), 4);
  derive();
  const v1::Job done = store_->job(job.id());
  EXPECT_EQ(done.state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(done.refine_round(), 3U);
  EXPECT_TRUE(refined(job.id()) == expected_refined(4));
  EXPECT_TRUE(field(job.id()) == expected_field(kRefinePoints, kRefineDirections));
}

// Its answer was lost, and the refinement has begun: nothing would merge what is logged now.
TEST_F(RefineTest, TheLastReportOfTheErosionMayComeAgain) {
  const v1::Job job = prepare_infimum();
  const v1::FieldRecords few = made_up_records(job, 0, 1);
  v1::Lease last;
  while (store_->job(job.id()).stage() == v1::JOB_STAGE_ERODE) {
    last = lease();
    report(last, {last.positions(0)}, few, true);
  }
  report(last, {last.positions(0)}, few, true);
  EXPECT_EQ(store_->job(job.id()).stage(), v1::JOB_STAGE_REFINE);
  store_.reset();
  Database db(database(), Database::Mode::kReadOnly);
  EXPECT_EQ(db.integer("SELECT count(*) FROM field_log"), 0);
}

TEST_F(RefineTest, WhatComesOutDoesNotDependOnWhoDidWhatWhenAndHowOften) {
  const v1::Job job = erode_infimum();
  std::uint32_t turn = 0;
  while (store_->job(job.id()).stage() == v1::JOB_STAGE_REFINE) {
    const v1::Lease task = lease(turn % 2 == 0 ? "worker-a" : "worker-b");
    const std::uint64_t begin = task.positions(0).begin(), end = task.positions(0).end();
    const std::uint64_t middle = begin + (end - begin) * (turn % 5) / 5;
    if (middle > begin) report_points(task, begin, middle);
    if (turn % 3 == 1 && middle > begin) {
      // Another goes on from there; and the server is another one.
      store_->give_back(task.token());
      open();
    } else {
      report_points(task, begin, end, true);  // some of it again
    }
    ++turn;
  }
  EXPECT_GT(turn, 20U);
  EXPECT_TRUE(refined(job.id()) == expected_refined(4));
}

TEST_F(RefineTest, AnInputIsWhatTheRoundsBeforeHaveLeft) {
  const v1::Job job = erode_infimum();
  const v1::Lease early = lease();
  EXPECT_STORE_ERROR(store_->open_input(early.token(), v1::ARTIFACT_KIND_REFINED), kPrecondition);
  finish_points(early);
  finish_rounds(job.id(), 2);
  const v1::Lease task = lease();
  ASSERT_EQ(task.round(), 2U);
  report_points(task, task.positions(0).begin(), task.positions(0).begin() + 50);
  EXPECT_TRUE(read_all(*store_->open_input(task.token(), v1::ARTIFACT_KIND_REFINED)) == expected_refined(2));
  // Who knows round 0 hears of round 1, who knows that of nothing.
  const std::string changes = read_all(*store_->open_input(task.token(), v1::ARTIFACT_KIND_REFINED, 0));
  ASSERT_EQ(changes.size(), (kRefinePoints + 2) / 3 * wire::kRefinedPointRecordBytes);
  for (std::size_t i = 0; i * wire::kRefinedPointRecordBytes < changes.size(); ++i) {
    const wire::RefinedPointRecord named =
        wire::decode_refined_point_record(changes.data() + i * wire::kRefinedPointRecordBytes);
    EXPECT_EQ(named.record.round, 1U);
    EXPECT_EQ(named.record.erosion, refined_erosion(named.point, 1));
  }
  EXPECT_EQ(read_all(*store_->open_input(task.token(), v1::ARTIFACT_KIND_REFINED, 1)), "");
}

// A log that has grown long goes into the field but for the last round; who lacks more gets all.
TEST_F(RefineTest, AMergedLogGivesTheSame) {
  const v1::Job job = erode_infimum();
  finish_rounds(job.id(), 3);
  {
    Database db(database(), Database::Mode::kReadWrite);
    Transaction merging(db);
    merge_refined_log(db, 1, kRefinePoints, 1);
    merging.commit();
  }
  const v1::Lease task = lease();
  const auto input = [&](std::optional<std::int64_t> known) {
    return read_all(*store_->open_input(task.token(), v1::ARTIFACT_KIND_REFINED, known));
  };
  const std::string whole = input(std::nullopt), all = input(0), last = input(1);
  EXPECT_TRUE(whole == expected_refined(3));
  ASSERT_EQ(all.size(), kRefinePoints * wire::kRefinedPointRecordBytes);
  for (std::uint32_t p = 0; p < kRefinePoints; ++p) {
    const std::size_t at = p * wire::kRefinedPointRecordBytes;
    EXPECT_EQ(wire::decode_refined_point_record(all.data() + at).point, p);
    EXPECT_EQ(all.substr(at + 4, wire::kRefinedRecordBytes),
              whole.substr(p * wire::kRefinedRecordBytes, wire::kRefinedRecordBytes));
  }
  EXPECT_EQ(last.size(), kRefinePoints / 100 * wire::kRefinedPointRecordBytes);
  store_->give_back(task.token());
  finish_rounds(job.id(), 4);
  EXPECT_TRUE(refined(job.id()) == expected_refined(4));
}

TEST_F(RefineTest, RefusesWhatCannotBeAndKeepsNothingOfIt) {
  const v1::Job job = erode_infimum();
  const v1::Lease task = lease();
  const auto refused = [&](const auto& change) {
    v1::ReportErosionHeader header = header_of(task, 0, 4, false);
    v1::RefinedRecords records = refined_records(0, 4, 0);
    change(header, records);
    EXPECT_STORE_ERROR(report_refined(header, records), kInvalid);
  };
  using Header = v1::ReportErosionHeader;
  using Records = v1::RefinedRecords;
  refused([](Header&, Records& r) { r.set_erosion(1, std::nan("")); });
  refused([](Header&, Records& r) { r.set_erosion(1, 0); });
  refused([](Header&, Records& r) { r.set_erosion(1, -1); });
  refused([](Header&, Records& r) { r.set_erosion(1, std::numeric_limits<double>::infinity()); });
  refused([](Header&, Records& r) { r.set_erosion(1, 17); });  // above the volume
  refused([](Header&, Records& r) { r.set_erosion(1, 2); });   // above the set's
  refused([](Header&, Records& r) { r.set_slope(1, std::nan("")); });
  refused([](Header&, Records& r) { r.set_slope(1, -1); });
  refused([](Header&, Records& r) { r.set_normal(3, 0.7); });
  refused([](Header&, Records& r) { r.set_normal(3, std::nan("")); });
  refused([](Header&, Records& r) { r.set_saddle(2, kRefineVertices); });
  refused([](Header&, Records& r) { r.set_point(3, kRefinePoints); });
  refused([](Header&, Records& r) { r.set_point(3, 4); });  // not called done, and 3 has none
  refused([](Header&, Records& r) { r.set_point(3, 2); });
  refused([](Header&, Records& r) { r.mutable_slope()->RemoveLast(); });
  refused([](Header&, Records& r) { r = refined_records(0, 3, 0); });
  refused([](Header& h, Records&) { h.set_round(1); });
  refused([](Header& h, Records&) { h.mutable_positions_done(0)->set_end(kRefinePoints + 1); });
  refused([](Header& h, Records&) { h.set_block_done(true); });
  refused([](Header& h, Records&) {
    while (h.positions_done_size() <= 256) *h.add_positions_done() = h.positions_done(0);
  });
  EXPECT_EQ(store_->job(job.id()).refined_points(), 0U);
  // Neither is it a report on directions, or a result.
  EXPECT_STORE_ERROR(report(task, 0, 4), kInvalid);
  EXPECT_STORE_ERROR(store_->complete(derive_header(task.token(), "x", 1), "x"), kInvalid);
  report_points(task, 0, 4);
  EXPECT_EQ(store_->job(job.id()).refined_points(), 4U);
}

TEST_F(RefineTest, ALastReportMayBeRepeatedWhenTheNextRoundHasBegun) {
  const v1::Job job = erode_infimum();
  v1::Lease last;
  while (store_->job(job.id()).refine_round() == 0) {
    last = lease();
    finish_points(last);
  }
  EXPECT_FALSE(report_points(last, last.positions(0).begin(), last.positions(0).end(), true).cancelled());
  finish_rounds(job.id(), 2);
  EXPECT_STORE_ERROR(report_points(last, last.positions(0).begin(), last.positions(0).end(), true), kFenced);
}

TEST_F(RefineTest, CancelledAmidARoundItGoesOnFromThere) {
  const v1::Job job = erode_infimum();
  const v1::Lease task = lease();
  report_points(task, 0, 60);
  store_->cancel(job.id());
  EXPECT_TRUE(report_points(task, 60, 80).cancelled());
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_FALSE(has_work());
  store_->resume(job.id());
  EXPECT_EQ(lease().positions(0).begin(), 80U);
  EXPECT_EQ(store_->job(job.id()).refined_points(), 80U);
}

TEST_F(RefineTest, WhoGaveRefinedValuesIsNamedAndCanBeDistrusted) {
  const v1::Job job = erode_infimum();
  while (store_->job(job.id()).stage() == v1::JOB_STAGE_REFINE)
    finish_points(lease(store_->job(job.id()).refine_round() == 1 ? "worker-b" : "worker-a"));
  derive();
  const auto givers = store_->events(job.id(), 0).givers();
  ASSERT_EQ(givers.size(), 2);
  EXPECT_EQ(givers[1].worker(), "worker-b");
  EXPECT_EQ(givers[1].directions(), 0U);
  EXPECT_EQ(givers[1].points(), (kRefinePoints + 2) / 3);
  // It gave no direction: these stay.
  const v1::Job again = store_->resume_without(job.id(), "worker-b");
  EXPECT_EQ(again.stage(), v1::JOB_STAGE_REFINE);
  EXPECT_EQ(again.directions_done(), kRefineDirections);
  EXPECT_EQ(again.refine_round(), 0U);
  EXPECT_STORE_ERROR(lease("worker-b"), kForbidden);
  finish_rounds(job.id(), 4);
  derive();
  EXPECT_TRUE(refined(job.id()) == expected_refined(4));
}

TEST_F(RefineTest, ADistrustedGiverOfDirectionsTakesTheRefinementAlong) {
  const v1::Job job = erode_infimum();
  finish_rounds(job.id(), 2);
  const v1::Job again = store_->resume_without(job.id(), "worker-a");
  EXPECT_EQ(again.stage(), v1::JOB_STAGE_ERODE);
  EXPECT_EQ(again.directions_done(), 0U);
}

TEST_F(RefineTest, WhatADeletedJobHasLeftGoes) {
  const v1::Job done = erode_infimum();
  finish_rounds(done.id(), 2);
  store_->cancel(done.id());
  store_->remove(done.id());
  while (store_->tidy()) {
  }
  Database db(database(), Database::Mode::kReadOnly);
  for (const char* sql : {"SELECT count(*) FROM erosions", "SELECT count(*) FROM refined_chunks",
                          "SELECT count(*) FROM refined_log", "SELECT count(*) FROM refined_ranges",
                          "SELECT count(*) FROM refined_givers", "SELECT sum(stored_bytes) FROM owner_use"}) {
    EXPECT_EQ(db.integer(sql), 0) << sql;
  }
}

TEST_F(RefineTest, TheRefinedFieldCountsToWhatItsOwnerHas) {
  erode_infimum();
  Database db(database(), Database::Mode::kReadOnly);
  EXPECT_EQ(db.integer("SELECT bytes - (SELECT sum(bytes) FROM artifacts) FROM erosions"),
            kRefinePoints * (20 + wire::kRefinedRecordBytes));
}

TEST_F(RefineTest, TheMinimumIsContent) {
  const v1::Job set = submit(), infimum = submit_infimum();
  EXPECT_NE(set.id(), infimum.id());
  EXPECT_EQ(submit().id(), set.id());
  EXPECT_EQ(submit_infimum().id(), infimum.id());
  EXPECT_EQ(set.params().minimum(), v1::MINIMUM_SET);
}

TEST_F(RefineTest, AJobOverASetHasNoRefinedField) {
  const v1::Job job = complete_job(20, 16);
  EXPECT_EQ(job.refine_round(), 0U);
  EXPECT_STORE_ERROR(refined(job.id()), kPrecondition);
}

}  // namespace
}  // namespace affskel::server
