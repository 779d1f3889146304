// The operations as a face that is no terminal uses them: values in, values out.
#include <algorithm>

#include "client/operations/fetch.h"
#include "client/operations/page.h"
#include "client/operations/picture.h"
#include "client/operations/submission.h"
#include "client_fixture.h"
#include "test_environment.h"
#include "tools/files.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

class OperationsTest : public ClientTest {
 protected:
  v1::Job job() { return session_.get_job("@last"); }

  Environment environment_ = test_environment({{"HOME", dir_.path()}});
  Session session_{choose_server(server_.address(), environment_), environment_, {}};
};

v1::SkeletonPoints empty_skeleton() {
  v1::SkeletonPoints skeleton;
  skeleton.mutable_quality()->set_advice("the largest is 3.");
  v1::Setting& setting = *skeleton.mutable_quality()->add_to_try();
  setting.set_name("threshold");
  setting.set_value("2.5");
  return skeleton;
}

// What every face shows must not be in the words of one.
testing::AssertionResult are_plain(const Notices& notices) {
  for (const Notice& notice : notices) {
    if (notice.message.find("--") != std::string::npos || notice.code.empty())
      return testing::AssertionFailure() << notice.code << ": " << notice.message;
  }
  return testing::AssertionSuccess();
}

TEST_F(OperationsTest, FetchTellsWhatItWrote) {
  const Fetched fetched = fetch(session_, {"@last", "skeleton", {dir_ / "s.csv"}});
  EXPECT_EQ(fetched.artifact, "skeleton");
  EXPECT_EQ(fetched.items, 2U);
  EXPECT_EQ(fetched.job.id(), service_.job.id());
  EXPECT_TRUE(fetched.notices.empty());
  const std::string text = tests::read_file(dir_ / "s.csv");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << "a header and two points";
}

TEST_F(OperationsTest, AnEmptySkeletonIsAWarningWithASettingToTry) {
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = empty_skeleton().SerializeAsString();
  const Fetched fetched = fetch(session_, {"@last", "skeleton", {dir_ / "s.csv"}});
  ASSERT_EQ(fetched.notices.size(), 1U);
  const Notice& notice = fetched.notices[0];
  EXPECT_EQ(notice.kind, Notice::Kind::kWarning);
  EXPECT_EQ(notice.code, "EMPTY_SKELETON");
  ASSERT_EQ(notice.to_try.size(), 1U);
  EXPECT_EQ(notice.to_try[0].name(), "threshold");
  EXPECT_EQ(notice.to_try[0].value(), "2.5");
  EXPECT_TRUE(are_plain(fetched.notices));
}

TEST_F(OperationsTest, EmptyThingsAreWarnedOfInPlainWords) {
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = "";
  service_.artifacts[v1::ARTIFACT_KIND_ERODED_SURFACE] = "";
  service_.artifacts[v1::ARTIFACT_KIND_ERODED_POINTS] = "";
  for (const auto& [artifact, file] :
       {std::pair{"surface", "a.off"}, {"eroded", "b.off"}, {"eroded", "c.csv"}}) {
    FetchRequest request{"@last", artifact, {dir_ / file}};
    const Notices notices = fetch(session_, request).notices;
    EXPECT_EQ(notices.size(), 1U) << artifact;
    EXPECT_TRUE(are_plain(notices));
    request.skeleton.operator_name = "zucker-hummel";
    EXPECT_TRUE(are_plain(fetch(session_, request).notices));
  }
}

TEST_F(OperationsTest, TheExtensionOrTheFormChoosesWhatIsFetchedOfAnErodedSolid) {
  FetchRequest request{"@last", "eroded", {dir_ / "e.ply"}};
  EXPECT_EQ(fetch(session_, request).unit, "triangle");
  request.form = FetchRequest::Form::kPoints;
  EXPECT_EQ(fetch(session_, request).unit, "point");
  request.destination = {dir_ / "e.xyz"};
  request.form = FetchRequest::Form::kByExtension;
  EXPECT_EQ(fetch(session_, request).unit, "point");
}

TEST_F(OperationsTest, PicturesAndPagesWarnAsFetchDoes) {
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = empty_skeleton().SerializeAsString();
  PictureOptions options;
  options.skeleton.operator_name = "zucker-hummel";
  const Picture picture = make_picture(session_, job(), options);
  EXPECT_TRUE(picture.png.starts_with("\x89PNG"));
  ASSERT_EQ(picture.notices.size(), 1U);
  EXPECT_EQ(picture.notices[0].code, "EMPTY_SKELETON");
  const Page page = make_page(session_, {{job(), skeleton_params(options.skeleton)}});
  EXPECT_NE(page.html.find("<html"), std::string::npos);
  ASSERT_FALSE(page.notices.empty());
  EXPECT_EQ(page.notices[0].code, "SKELETON") << "the points are there, the advice as well";
}

TEST_F(OperationsTest, SubmitNamesTheUserToAServerThatDoesNotKnowWhoCalls) {
  service_.caller.clear_owner();
  const InputFile input = read_input(dir_ / "cube.off");
  const Submitted submitted = submit(session_, environment_, input, nullptr, {});
  EXPECT_EQ(submitted.job.id(), service_.job.id());
  EXPECT_EQ(service_.submitted.owner(), user_name(environment_));
  EXPECT_EQ(service_.submitted.name(), "cube");
}

TEST_F(OperationsTest, ARepairedMeshIsSubmittedWithWhatItWas) {
  InputFile input = read_input(dir_ / "cube.off");
  const std::string before = input.bytes;
  input.off.mesh.triangles.pop_back();
  const MeshSource source =
      replace_mesh(input, repair(input.off.mesh, "cube.off", {RepairChoice::Kind::kFill, 1e9}));
  EXPECT_EQ(source.bytes, before);
  submit(session_, environment_, input, &source, {});
  const v1::MeshRepair& sent = service_.submitted.repair();
  EXPECT_EQ(sent.source_sha256(), wire::sha256_hex(before));
  EXPECT_EQ(sent.source_bytes(), before.size());
  ASSERT_EQ(sent.steps_size(), 1);
  EXPECT_EQ(sent.steps(0).code(), "filled-holes");
  EXPECT_EQ(service_.mesh, input.bytes);
  EXPECT_EQ(service_.source, before);
  service_.max_mesh_bytes = input.bytes.size() - 1;
  EXPECT_THROW(submit(session_, environment_, input, &source, {}), ClientError);
}

TEST_F(OperationsTest, FewerDirectionsAreAdvisedForScansAndWraps) {
  core::Solid solid;
  solid.mesh.triangles.resize(132'000);
  const Notices notices = direction_notices(solid, {});
  ASSERT_EQ(notices.size(), 1U);
  EXPECT_EQ(notices[0].kind, Notice::Kind::kNote);
  EXPECT_NE(notices[0].message.find("132000 triangles"), std::string::npos) << notices[0].message;
  ASSERT_EQ(notices[0].to_try.size(), 1U);
  EXPECT_EQ(notices[0].to_try[0].name(), "directions");
  EXPECT_TRUE(are_plain(notices));
  Submission fewer, infimum;
  fewer.directions = "sphere:5000";
  infimum.minimum = "infimum";
  EXPECT_TRUE(direction_notices(solid, fewer).empty());
  EXPECT_TRUE(direction_notices(solid, infimum).empty()) << "they are a beginning there";
  solid.mesh.triangles.resize(5000);
  EXPECT_TRUE(direction_notices(solid, {}).empty());
}

TEST_F(OperationsTest, TextsThatTheProtocolHasNoRoomForAreRefused) {
  Submission submission;
  submission.name = std::string(201, 'n');
  try {
    submit(session_, environment_, read_input(dir_ / "cube.off"), nullptr, submission);
    FAIL();
  } catch (const ClientError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::kUsage);
    EXPECT_NE(std::string(error.what()).find("the name has 201 bytes"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace affskel::client
