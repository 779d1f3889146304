# add_sharded_tests(TARGET COUNT): the tests of a program of GoogleTest, parted among COUNT processes.  A process each
# would start two thousand programs, which takes longer than most of the tests.
function(add_sharded_tests target count)
  math(EXPR last "${count} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME ${target}.${shard} COMMAND ${target} --gtest_brief=1)
    set_tests_properties(${target}.${shard} PROPERTIES LABELS fast TIMEOUT 600 COST 30
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${count};GTEST_SHARD_INDEX=${shard}")
  endforeach()
endfunction()
