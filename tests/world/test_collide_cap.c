// The cap on support calls, made so low that it is met: the door of the real one cannot reach it.
#include "gen.h"
#include "unity.h"

#define AISLE_COLLIDE_SUPPORT_MAX 7U
#define aisle_collide capped_collide
#include "../../src/world/collide.c"

void setUp(void) {}
void tearDown(void) {}

static void test_a_query_past_the_cap_ends_and_is_answered_as_touching(void) {
    aisle_rng rng = aisle_rng_seed(78);
    aisle_collide_count count = {0};
    int64_t unfit = 0;
    for (uint32_t i = 0; i < 20000U; i++) {
        aisle_vec2 a[8];
        aisle_vec2 b[8];
        gen_polygon(&rng, aisle_vec2_of(0, 0), 1.0, 0.5, 8, a);
        gen_polygon(&rng, aisle_vec2_of(gen_in(&rng, -3, 3), gen_in(&rng, -3, 3)), 0.7, 0.7, 8, b);
        const bool hit =
            capped_collide(&(aisle_collide_body){a, NULL, 8, 0.1}, &(aisle_collide_body){b, NULL, 8, 0.1}, &count);
        const long double gap = judge_gap(&(aisle_convex){a, 8, 0.1}, &(aisle_convex){b, 8, 0.1});
        TEST_ASSERT_TRUE(hit || gap > 0.0L);
        TEST_ASSERT_TRUE(count.unfit == unfit || hit);
        unfit = count.unfit;
    }
    TEST_ASSERT_TRUE(unfit > 1000);
    TEST_ASSERT_TRUE(count.support_max > AISLE_COLLIDE_SUPPORT_MAX && count.support_max < 30U); // ended soon after
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_a_query_past_the_cap_ends_and_is_answered_as_touching);
    return UNITY_END();
}
