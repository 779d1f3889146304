#include "wire/params.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/published_threshold.h"

namespace affskel::wire {
namespace {

v1::ErosionParams erosion(const std::string& directions, double spacing = 1.0) {
  v1::ErosionParams params;
  params.mutable_sampling()->set_spacing(spacing);
  params.set_directions(directions);
  return params;
}

TEST(ParamsTest, DirectionSetsHaveOneSpelling) {
  EXPECT_EQ(canonical(erosion("")).directions(), "triangles");
  EXPECT_EQ(canonical(erosion("sphere:0100")).directions(), "sphere:100");
  EXPECT_EQ(canonical(erosion("triangles+random:5:007")).directions(), "triangles+random:5:7");
  EXPECT_EQ(canonical(erosion("random:5:18446744073709551615")).directions(),
            "random:5:18446744073709551615");
}

TEST(ParamsTest, RefusesWhatIsNoDirectionSet) {
  for (const char* bad :
       {"circle", "triangles:3", "sphere", "sphere:", "sphere:0", "sphere:-1", "sphere:1e3", "sphere:5:1",
        "random:5", "random:5:", "random:5:-1", "random:5:18446744073709551616", "+", "triangles+",
        "+triangles", " triangles", "sphere:2147483649"}) {
    EXPECT_THROW(canonical(erosion(bad)), std::invalid_argument) << bad;
  }
}

TEST(ParamsTest, RefusesSamplingsOutOfRange) {
  for (double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_THROW(canonical(erosion("", bad)), std::invalid_argument) << bad;
  }
  v1::ErosionParams params;
  EXPECT_THROW(canonical(params), std::invalid_argument);
  params.mutable_sampling()->set_target_points(0);
  EXPECT_THROW(canonical(params), std::invalid_argument);
  params.mutable_sampling()->set_target_points(1);
  EXPECT_NO_THROW(canonical(params));
}

TEST(ParamsTest, KeysTellEveryBitOfTheSpacing) {
  const double spacing = 200;
  EXPECT_EQ(cache_key(canonical(erosion("", spacing))), cache_key(canonical(erosion("triangles", spacing))));
  EXPECT_NE(cache_key(canonical(erosion("", spacing))),
            cache_key(canonical(erosion("", std::nextafter(spacing, 201.0)))));
  v1::ErosionParams repaired = erosion("", spacing);
  repaired.set_repair(true);
  EXPECT_NE(cache_key(canonical(erosion("", spacing))), cache_key(canonical(repaired)));
}

TEST(ParamsTest, FramesAreNamedInKeysUnlessTheyAreTheMeshs) {
  const v1::ErosionParams plain = canonical(erosion("", 200));
  EXPECT_EQ(plain.frame(), v1::FRAME_AXIS);
  EXPECT_EQ(cache_key(plain), "spacing=4069000000000000 directions=triangles repair=0")
      << "keys of stored jobs must stay what they are";
  v1::ErosionParams axis = erosion("", 200), affine = axis, pca = axis, unknown = axis;
  axis.set_frame(v1::FRAME_AXIS);
  EXPECT_EQ(cache_key(canonical(axis)), cache_key(plain));
  affine.set_frame(v1::FRAME_AFFINE);
  EXPECT_EQ(canonical(affine).frame(), v1::FRAME_AFFINE);
  EXPECT_EQ(cache_key(canonical(affine)), cache_key(plain) + " frame=4");
  pca.set_frame(v1::FRAME_PCA);
  EXPECT_EQ(cache_key(canonical(pca)), cache_key(plain) + " frame=2");
  v1::ErosionParams infimum = plain;
  infimum.set_minimum(v1::MINIMUM_INFIMUM);
  EXPECT_EQ(plain.minimum(), v1::MINIMUM_SET);
  EXPECT_EQ(cache_key(canonical(infimum)), cache_key(plain) + " minimum=infimum")
      << "the schema knows the word";
  infimum.set_minimum(static_cast<v1::Minimum>(9));
  EXPECT_THROW(canonical(infimum), std::invalid_argument);
  unknown.set_frame(static_cast<v1::Frame>(77));
  EXPECT_THROW(canonical(unknown), std::invalid_argument);
}

TEST(ParamsTest, SkeletonDefaultsAreFilledIn) {
  const v1::SkeletonParams filled = canonical(v1::SkeletonParams());
  EXPECT_EQ(filled.operator_(), v1::OPERATOR_RIDGE);
  EXPECT_EQ(filled.threshold(), 0) << "its default depends on more";
  v1::SkeletonParams published;
  published.set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  EXPECT_EQ(canonical(published).threshold(), base::kZuckerHummelThreshold);
  v1::SkeletonParams negative_zero;
  negative_zero.set_threshold(-0.0);
  EXPECT_EQ(cache_key(canonical(negative_zero)), cache_key(filled));
  v1::SkeletonParams bad;
  bad.set_threshold(std::nan(""));
  EXPECT_THROW(canonical(bad), std::invalid_argument);
}

TEST(ParamsTest, SurfaceKeysIncludeTheSkeleton) {
  v1::SurfaceParams plain;
  v1::SurfaceParams finer;
  finer.mutable_skeleton()->set_threshold(3);
  EXPECT_NE(cache_key(canonical(plain)), cache_key(canonical(finer)));
  v1::SurfaceParams bad;
  bad.set_alpha(-1);
  EXPECT_THROW(canonical(bad), std::invalid_argument);
}

TEST(ParamsTest, OperatorsOtherThanTheFirstKeepTheirDefaultOpen) {
  v1::SkeletonParams params;
  params.set_operator_(v1::OPERATOR_CENTRAL);
  EXPECT_EQ(canonical(params).threshold(), 0);
  EXPECT_NE(cache_key(canonical(params)), cache_key(canonical(v1::SkeletonParams())));
  params.set_operator_(v1::OPERATOR_CHORDS);
  params.set_threshold(1);
  EXPECT_EQ(canonical(params).threshold(), 1);
  params.set_threshold(std::nextafter(1.0, 2.0));
  EXPECT_THROW(canonical(params), std::invalid_argument) << "a share";
  params.set_operator_(v1::OPERATOR_RIDGE);
  EXPECT_NO_THROW(canonical(params)) << "an angle";
  params.set_threshold(801);
  EXPECT_THROW(canonical(params), std::invalid_argument) << "more than is counted";
  params.set_operator_(v1::OPERATOR_CURVE);
  for (const double threshold : {0.0, 0.9, 1000.0}) {
    params.set_threshold(threshold);
    EXPECT_NO_THROW(canonical(params)) << "radii";
  }
  for (const double threshold : {0.89, 1001.0}) {
    params.set_threshold(threshold);
    EXPECT_THROW(canonical(params), std::invalid_argument) << threshold;
  }
  params.set_threshold(0);
  params.set_operator_(static_cast<v1::Operator>(99));
  EXPECT_THROW(canonical(params), std::invalid_argument);
}

TEST(ParamsTest, SheetsHaveNoAlpha) {
  for (const v1::Operator which : {v1::OPERATOR_CHORDS, v1::OPERATOR_RIDGE, v1::OPERATOR_CURVE}) {
    v1::SurfaceParams params;
    params.mutable_skeleton()->set_operator_(which);
    EXPECT_NO_THROW(canonical(params));
    params.set_alpha(1);
    EXPECT_THROW(canonical(params), std::invalid_argument);
  }
}

TEST(ParamsTest, BarriersAreForSheets) {
  v1::SurfaceParams points, sheet;
  points.mutable_skeleton()->set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  points.set_barrier(true);
  EXPECT_THROW(canonical(points), std::invalid_argument);
  points.set_barrier(false);
  points.set_min_barrier(0.1);
  EXPECT_THROW(canonical(points), std::invalid_argument);
  sheet.set_barrier(true);
  sheet.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  EXPECT_THROW(canonical(sheet), std::invalid_argument) << "lines have no two sides";
  sheet.set_barrier(false);
  sheet.mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  const std::string plain = cache_key(canonical(sheet));
  sheet.set_min_barrier(-0.0);
  EXPECT_EQ(cache_key(canonical(sheet)), plain);
  EXPECT_EQ(plain.find("barrier"), std::string::npos) << "keys from before there were barriers";
  sheet.set_min_barrier(0.1);
  EXPECT_TRUE(canonical(sheet).barrier()) << "nothing can be dropped without";
  const std::string cut = cache_key(canonical(sheet));
  sheet.set_barrier(true);
  EXPECT_EQ(cache_key(canonical(sheet)), cut);
  sheet.set_min_barrier(0);
  EXPECT_NE(cache_key(canonical(sheet)), cut);
  EXPECT_NE(cache_key(canonical(sheet)), plain);
  for (const double least : {-0.1, std::nan(""), HUGE_VAL}) {
    sheet.set_min_barrier(least);
    EXPECT_THROW(canonical(sheet), std::invalid_argument) << least;
  }
}

TEST(ParamsTest, DivergenceDependsOnTheOperatorAlone) {
  v1::SkeletonParams params;
  params.set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  const v1::SkeletonParams first = divergence_params(canonical(params));
  params.set_threshold(3);
  EXPECT_EQ(cache_key(divergence_params(canonical(params))), cache_key(first));
  params.set_operator_(v1::OPERATOR_SOBEL);
  EXPECT_NE(cache_key(divergence_params(canonical(params))), cache_key(first));
  params.set_operator_(v1::OPERATOR_RIDGE);
  EXPECT_THROW(divergence_params(canonical(params)), std::invalid_argument);
  params.set_threshold(0.5);
  params.set_operator_(v1::OPERATOR_CHORDS);
  EXPECT_THROW(divergence_params(canonical(params)), std::invalid_argument);
  EXPECT_EQ(usual_divergence(v1::OPERATOR_SOBEL), v1::OPERATOR_SOBEL);
  for (const v1::Operator sheet : {v1::OPERATOR_RIDGE, v1::OPERATOR_CHORDS, v1::OPERATOR_CURVE})
    EXPECT_EQ(usual_divergence(sheet), v1::OPERATOR_ZUCKER_HUMMEL) << "the published one";
}

TEST(ParamsTest, ErodedLevelsAreSharesOrVolumes) {
  EXPECT_EQ(canonical(v1::ErodedParams()).fraction(), kErodedFraction);
  v1::ErodedParams share, volume;
  share.set_fraction(0.25);
  volume.set_volume(0.25);
  EXPECT_NE(cache_key(canonical(share)), cache_key(canonical(volume)));
  for (double bad : {0.0, 1.0, -0.5, std::nan("")}) {
    share.set_fraction(bad);
    EXPECT_THROW(canonical(share), std::invalid_argument) << bad;
  }
  for (double bad : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    volume.set_volume(bad);
    EXPECT_THROW(canonical(volume), std::invalid_argument) << bad;
  }
}

}  // namespace
}  // namespace affskel::wire
