// Runs the properties with a fixed seed unless RC_PARAMS in the environment says otherwise, so that what
// continuous integration sees can be seen again.
#include <gtest/gtest.h>

#include <cstdlib>

int main(int argc, char** argv) {
  setenv("RC_PARAMS", "seed=20031117 max_success=500 max_size=100", 0);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
