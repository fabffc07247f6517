#include "sim/movers.h" // first: proves that the header stands alone

#include "hall.h"

static aisle_sim_scene scene;
static aisle_sim_movers movers;
static const double dt = 0.005;

void setUp(void) {
    hall_begin(20.0, 15.0);
    hall_add(5.0, 4.0, 7.0, 9.0);
    hall_add(12.0, 6.0, 15.0, 7.0);
    hall_open(&scene);
}
void tearDown(void) {
    aisle_sim_scene_free(&scene);
}

// A vehicle that drives to and fro.
static aisle_sim_prey prey_at(int step) {
    int phase = step % 4000;
    double x = phase < 2000 ? 2.0 + 0.0075 * phase : 17.0 - 0.0075 * (phase - 2000);
    return (aisle_sim_prey){.at = {x, 2.0}, .velocity = {phase < 2000 ? 1.5 : -1.5, 0.0}, .reach = 0.6};
}

static void fill(aisle_sim_kind kind, uint32_t count, uint64_t seed) {
    aisle_sim_prey prey = prey_at(0);
    aisle_sim_movers_start(&movers, &scene, seed);
    for (uint32_t i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(aisle_sim_movers_add(&movers, kind, 0.0, &prey, 2.0));
    }
}

static void test_none_ever_exceeds_its_bound_or_jumps(void) {
    for (int kind = 0; kind < (int)AISLE_SIM_TRACK; kind++) {
        for (uint64_t seed = 0; seed < 10; seed++) {
            fill((aisle_sim_kind)kind, 8, seed);
            for (int step = 0; step < 8000; step++) {
                aisle_pose2 before[8];
                for (int i = 0; i < 8; i++) {
                    before[i] = movers.mover[i].pose;
                }
                aisle_sim_prey prey = prey_at(step);
                aisle_sim_movers_step(&movers, dt, &prey);
                for (int i = 0; i < 8; i++) {
                    const aisle_sim_mover *m = &movers.mover[i];
                    double moved = hypot(m->pose.x - before[i].x, m->pose.y - before[i].y);
                    TEST_ASSERT_TRUE_MESSAGE(moved <= m->v_bound * dt * (1.0 + 1e-9) + 1e-12,
                                             aisle_sim_kind_name(m->kind));
                    TEST_ASSERT_TRUE(m->pose.theta == before[i].theta);
                    TEST_ASSERT_TRUE(m->told_v_bound == 0.0F || (double)m->told_v_bound >= m->v_bound);
                    bool in_a_nook = m->kind == AISLE_SIM_CONSTANT && moved == 0.0;
                    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(in_a_nook ? 1.0 : 1e-9, moved,
                                                      aisle_vec2_length(m->velocity) * dt,
                                                      aisle_sim_kind_name(m->kind));
                }
            }
        }
    }
}

static void test_what_is_told_by_kind_alone_is_the_kinds_bound(void) {
    for (int kind = 0; kind < (int)AISLE_SIM_TRACK; kind++) {
        fill((aisle_sim_kind)kind, 20, 3);
        for (int i = 0; i < 20; i++) {
            const aisle_sim_mover *m = &movers.mover[i];
            double usual = m->told_kind == AISLE_OBSTACLE_PERSON ? 1.6 : 2.0;
            TEST_ASSERT_TRUE(m->told_v_bound > 0.0F || m->v_bound == usual);
        }
    }
}

static void test_all_but_ghosts_keep_off_what_stands_still(void) {
    for (int kind = 0; kind < (int)AISLE_SIM_ADVERSARIAL; kind++) {
        fill((aisle_sim_kind)kind, 8, 5);
        for (int step = 0; step < 8000; step++) {
            aisle_sim_prey prey = prey_at(step);
            aisle_sim_movers_step(&movers, dt, &prey);
            for (int i = 0; i < 8 && step % 10 == 0; i++) {
                const aisle_sim_mover *m = &movers.mover[i];
                aisle_sim_outline body = aisle_sim_outline_at(&m->body, m->pose);
                TEST_ASSERT_TRUE_MESSAGE(aisle_sim_scene_gap(&scene, &body, 1.0, NULL) > 0.0,
                                         aisle_sim_kind_name(m->kind));
            }
        }
    }
}

static void test_they_move(void) {
    for (int kind = 0; kind < (int)AISLE_SIM_TRACK; kind++) {
        fill((aisle_sim_kind)kind, 8, 7);
        double way = 0.0;
        for (int step = 0; step < 4000; step++) {
            aisle_sim_prey prey = prey_at(step);
            aisle_sim_movers_step(&movers, dt, &prey);
            for (int i = 0; i < 8; i++) {
                way += aisle_vec2_length(movers.mover[i].velocity) * dt;
            }
        }
        TEST_ASSERT_TRUE_MESSAGE(way > 8 * 20.0 * 0.15, aisle_sim_kind_name((aisle_sim_kind)kind)); // 20 s each
    }
}

static void test_random_jumps_stay_within_a_metre_each_way(void) {
    fill(AISLE_SIM_JUMPS, 1, 11);
    aisle_sim_mover *m = &movers.mover[0];
    aisle_vec2 from = {m->pose.x, m->pose.y};
    double until = m->until;
    for (int step = 0; step < 20000; step++) {
        aisle_sim_prey prey = prey_at(step);
        aisle_vec2 at = {m->pose.x, m->pose.y};
        aisle_sim_movers_step(&movers, dt, &prey);
        if (m->until != until) {
            from = at;
            until = m->until;
        }
        TEST_ASSERT_TRUE(fabs(m->pose.x - from.x) < 1.0 + 1e-9 && fabs(m->pose.y - from.y) < 1.0 + 1e-9);
    }
}

static void test_adversaries_touch_a_vehicle_that_does_not_mind(void) {
    int touched = 0;
    for (uint64_t seed = 0; seed < 20; seed++) {
        fill(AISLE_SIM_ADVERSARIAL, 1, seed);
        bool touches = false;
        for (int step = 0; step < 12000 && !touches; step++) { // 60 s
            aisle_sim_prey prey = prey_at(step);
            aisle_sim_movers_step(&movers, dt, &prey);
            const aisle_sim_mover *m = &movers.mover[0];
            touches = hypot(m->pose.x - prey.at.x, m->pose.y - prey.at.y) < m->reach + prey.reach;
        }
        touched += touches ? 1 : 0;
    }
    TEST_ASSERT_TRUE(touched >= 18);
}

static void test_each_tactic_leads_to_a_vehicle_that_passes(void) {
    for (int tactic = 0; tactic < (int)AISLE_SIM_TACTIC_COUNT; tactic++) {
        fill(AISLE_SIM_ADVERSARIAL, 1, 1);
        aisle_sim_mover *m = &movers.mover[0];
        m->tactic = (aisle_sim_tactic)tactic;
        m->pose = (aisle_pose2){9.0, 3.5, 0.0};
        m->trigger = 2.0;
        m->v_bound = 2.0;
        m->until = 1e9;
        double least = 1e9, waited = 0.0;
        for (int step = 0; step < 2000; step++) {
            aisle_sim_prey prey = prey_at(step);
            aisle_sim_movers_step(&movers, dt, &prey);
            least = fmin(least, hypot(m->pose.x - prey.at.x, m->pose.y - prey.at.y) - m->reach - prey.reach);
            waited += aisle_vec2_length(m->velocity) == 0.0 && !m->is_set_off ? dt : 0.0;
        }
        TEST_ASSERT_TRUE(least < 0.0);
        TEST_ASSERT_TRUE((tactic == (int)AISLE_SIM_AMBUSH) == (waited > 2.0)); // only one lies in wait
    }
}

static void test_recorded_ones_do_not_appear_beside_the_vehicle(void) {
    static aisle_sim_sample sample[2] = {{1.0, {2.0, 3.0}}, {11.0, {12.0, 3.0}}}; // 1 m/s
    static aisle_sim_track track = {.count = 2, .v_max = 1.0};
    const aisle_sim_tracks tracks = {.sample = sample, .track = &track, .num_samples = 2, .num_tracks = 1};
    aisle_sim_prey prey = {.at = {2.0, 2.0}, .reach = 0.5, .stop_time = 2.0, .stop_way = 0.25};
    aisle_sim_movers_start(&movers, &scene, 1);
    TEST_ASSERT_TRUE(aisle_sim_movers_add_tracks(&movers, &tracks));
    const aisle_sim_mover *m = &movers.mover[0]; // told 1.6 m/s: within 0.25 + 0.5 + 3.2 + 0.25 m it stays away
    double first = 0.0;
    for (int step = 0; step < 3000; step++) {
        aisle_sim_movers_step(&movers, dt, &prey);
        if (m->is_there && first == 0.0) {
            first = movers.now;
            TEST_ASSERT_DOUBLE_WITHIN(0.01, 2.0 + sqrt(4.2 * 4.2 - 1.0), m->pose.x);
        }
        prey.at.x = m->is_there ? m->pose.x : prey.at.x; // once there it stays, however near
        TEST_ASSERT_TRUE(first == 0.0 || m->is_there == (movers.now <= 11.0));
    }
    TEST_ASSERT_TRUE(first > 4.0);
}

static void test_a_seed_gives_the_same_walks(void) {
    static aisle_sim_movers first;
    for (int run = 0; run < 2; run++) {
        fill(AISLE_SIM_PERSON, 10, 21);
        for (int step = 0; step < 4000; step++) {
            aisle_sim_prey prey = prey_at(step);
            aisle_sim_movers_step(&movers, dt, &prey);
        }
        if (run == 0) {
            first = movers;
        }
    }
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_MEMORY(&first.mover[i].pose, &movers.mover[i].pose, sizeof first.mover[i].pose);
    }
}

static void test_too_many_or_no_place_is_refused_and_nothing_is_added(void) {
    fill(AISLE_SIM_CONSTANT, AISLE_SIM_MOVERS_MAX, 1);
    aisle_sim_prey prey = prey_at(0);
    TEST_ASSERT_FALSE(aisle_sim_movers_add(&movers, AISLE_SIM_CONSTANT, 0.0, &prey, 2.0));
    fill(AISLE_SIM_CONSTANT, 1, 1);
    TEST_ASSERT_FALSE(aisle_sim_movers_add(&movers, AISLE_SIM_CONSTANT, 0.0, &prey, 100.0));
    TEST_ASSERT_FALSE(aisle_sim_movers_add(&movers, AISLE_SIM_TRACK, 0.0, &prey, 1.0));
    TEST_ASSERT_EQUAL_UINT32(1, movers.count);
}

static void test_names_lead_to_kinds_and_back(void) {
    for (int kind = 0; kind < (int)AISLE_SIM_KIND_COUNT; kind++) {
        TEST_ASSERT_EQUAL(kind, aisle_sim_kind_of(aisle_sim_kind_name((aisle_sim_kind)kind)));
    }
    TEST_ASSERT_EQUAL(AISLE_SIM_KIND_COUNT, aisle_sim_kind_of("persons"));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_none_ever_exceeds_its_bound_or_jumps);
    RUN_TEST(test_what_is_told_by_kind_alone_is_the_kinds_bound);
    RUN_TEST(test_all_but_ghosts_keep_off_what_stands_still);
    RUN_TEST(test_they_move);
    RUN_TEST(test_random_jumps_stay_within_a_metre_each_way);
    RUN_TEST(test_adversaries_touch_a_vehicle_that_does_not_mind);
    RUN_TEST(test_each_tactic_leads_to_a_vehicle_that_passes);
    RUN_TEST(test_recorded_ones_do_not_appear_beside_the_vehicle);
    RUN_TEST(test_a_seed_gives_the_same_walks);
    RUN_TEST(test_too_many_or_no_place_is_refused_and_nothing_is_added);
    RUN_TEST(test_names_lead_to_kinds_and_back);
    return UNITY_END();
}
