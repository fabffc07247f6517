#include "algo/ga.h" // first: proves that the header stands alone

enum { GENES_MAX = 14, POPULATION_MAX = 80, BYTES = 48 * 1024 };

static unsigned char memory[BYTES + 2U * AISLE_ARENA_ALIGN];
static unsigned char *block; // in it, aligned; canaries behind what is carved
static size_t carved;
static aisle_ga ga;
static aisle_ga_config cfg;

#define SEARCH(word) aisle_ga_##word
#define SELF ga
#define DIMENSIONS genes
#include "population_search.h"

static aisle_status start(void) {
    return aisle_ga_start(&ga, &cfg);
}

static void use_few_evaluations(void) {
    cfg.generation_max = 3;
}

static uint32_t evaluations_in_all(void) {
    return aisle_ga_evals_max(&cfg);
}

static void carve(uint16_t genes, uint16_t population) {
    block = memory + (AISLE_ARENA_ALIGN - (uintptr_t)memory % AISLE_ARENA_ALIGN);
    aisle_arena measure = aisle_arena_measure();
    aisle_ga_carve(NULL, &measure, genes, population);
    TEST_ASSERT_TRUE(measure.used <= BYTES);
    aisle_arena arena = aisle_arena_over(block, measure.used);
    aisle_ga_carve(&ga, &arena, genes, population);
    TEST_ASSERT_TRUE(!arena.overflow && arena.used == measure.used);
    carved = measure.used;
    memset(block + carved, 0xA5, AISLE_ARENA_ALIGN);
}

static void use(aisle_ga_config with) {
    cfg = with;
    cfg.cost = bowl;
    cfg.lo = lo;
    cfg.hi = hi;
    cfg.seed = 1;
    cfg.genes = DIM;
    cfg.value_goal = 1e-6F;
}

// The plain form as books have it: one bit of 1 / (bits of a chromosome) flips.
static void use_binary(uint32_t generations) {
    use(aisle_ga_paper(generations));
    cfg.bit = 20;
    cfg.pm = 1.0F / 60.0F;
}

void setUp(void) {
    memset(&ga, 0, sizeof ga);
    carve(GENES_MAX, POPULATION_MAX);
    use(aisle_ga_modern(DIM, 150));
}
void tearDown(void) {
    for (size_t i = 0; i < AISLE_ARENA_ALIGN; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xA5, block[carved + i]);
    }
}

static void test_minimum_on_the_wall_is_found_in_binary_for_100_of_100_seeds(void) {
    use_binary(300);
    cfg.value_goal = 1e-4F; // cliffs of the code keep it from more
    TEST_ASSERT_EQUAL_UINT32(100, hits_of(100));
}

static void test_rosenbrock_is_hit_for_100_of_100_seeds(void) {
    use_wide_box(2, 5.0F);
    cfg.cost = rosenbrock;
    cfg.generation_max = 1000;
    cfg.value_goal = 1e-4F;
    TEST_ASSERT_EQUAL_UINT32(100, hits_of(100));
}

static void test_rastrigin_is_hit_for_50_of_50_seeds(void) {
    use_wide_box(3, 5.12F);
    cfg.cost = rastrigin;
    cfg.generation_max = 400;
    cfg.value_goal = 1e-3F;
    TEST_ASSERT_EQUAL_UINT32(50, hits_of(50));
}

// Every way of coding, crossing and mutating.
static void use_way(uint32_t way) {
    use(way % 2U == 0U ? aisle_ga_modern(DIM, 40) : aisle_ga_paper(40));
    cfg.mutation = way / 2U % 2U == 0U ? AISLE_GA_EACH : AISLE_GA_ONE;
    cfg.crossover = way % 2U == 0U && way < 4U ? AISLE_GA_BLEND : AISLE_GA_UNIFORM;
    cfg.redraw = way == 6U;
    cfg.population = (uint16_t)(19U + way);
    cfg.elite = (uint16_t)(way % 3U);
    cfg.parents = way < 4U ? 0 : 10;
    cfg.value_goal = -INFINITY;
}

static void test_any_slicing_gives_the_same_bits(void) {
    for (uint32_t way = 0; way < 8U; way++) {
        use_way(way);
        expect_same_bits_in_slices();
        TEST_ASSERT_EQUAL_UINT32(aisle_ga_evals_max(&cfg), ga.evals);
    }
}

static void test_invariants_hold_after_every_evaluation(void) {
    for (uint32_t way = 0; way < 8U; way++) {
        use_way(way);
        cfg.cost = walled_bowl;
        expect_invariants_after_every_evaluation();
    }
}

// ---- the first population

static float asked[POPULATION_MAX][DIM];

static aisle_cost_pair note(void *ctx, const float *x) {
    (void)ctx;
    memcpy(asked[calls], x, sizeof asked[0]);
    expect_in_box(x);
    return (aisle_cost_pair){0.0F, 1.0F};
}

static void ask_first_population(void) {
    cfg.cost = note;
    cfg.value_goal = -INFINITY;
    cfg.generation_max = 0;
    calls = 0;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_ga_start(&ga, &cfg));
    TEST_ASSERT_EQUAL_UINT32(0, calls); // start() calls no cost
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, aisle_ga_step(&ga, UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(cfg.population, calls);
    TEST_ASSERT_TRUE(aisle_ga_invariants_hold(&ga)); // codes of 2^bit and more are none
}

static void test_first_points_asked_about_are_the_seeds(void) {
    const float seeds[2][DIM] = {{0.5F, 0.5F, 1.0F}, {-9.0F, 9.0F, 2.0F}};
    cfg.seeds = seeds[0];
    cfg.seed_count = 2;
    ask_first_population();
    TEST_ASSERT_EQUAL_MEMORY(seeds[0], asked[0], sizeof asked[0]);
    const float clamped[DIM] = {-1.0F, 2.0F, 2.0F};
    TEST_ASSERT_EQUAL_MEMORY(clamped, asked[1], sizeof asked[1]);
}

static void test_binary_seeds_are_within_one_step_of_the_code(void) {
    const float seeds[3][DIM] = {{0.5F, 0.5F, 1.0F}, {-1.0F, 2.0F, 5.0F}, {1.0F, -2.0F, 0.0F}};
    const uint16_t bits[4] = {1, 10, 20, 63};
    for (int k = 0; k < 4; k++) {
        use_binary(0);
        cfg.bit = bits[k];
        cfg.seeds = seeds[0];
        cfg.seed_count = 3;
        ask_first_population();
        for (int s = 0; s < 3; s++) {
            for (int i = 0; i < DIM; i++) {
                const double step = (double)(hi[i] - lo[i]) / ((double)((uint64_t)1 << bits[k]) - 1.0);
                TEST_ASSERT_TRUE(fabs((double)(asked[s][i] - seeds[s][i])) <= step + 1e-6);
                TEST_ASSERT_TRUE(s == 0 || asked[s][i] == seeds[s][i]); // the ends of the box have codes
            }
        }
    }
}

static void test_the_others_lie_within_the_spread_and_fill_it(void) {
    const float seeds[2][DIM] = {{0.0F, 0.0F, 2.5F}, {0.5F, -1.0F, 2.0F}};
    const float spreads[2] = {0.05F, 0.2F};
    cfg.seeds = seeds[0];
    cfg.seed_count = 2;
    cfg.population = POPULATION_MAX;
    for (int k = 0; k < 2; k++) {
        float farthest[DIM] = {0};
        cfg.spread = spreads[k];
        ask_first_population();
        for (int point = 2; point < POPULATION_MAX; point++) {
            for (int i = 0; i < DIM; i++) {
                farthest[i] = fmaxf(farthest[i], fabsf(asked[point][i] - seeds[point % 2][i]) / (hi[i] - lo[i]));
            }
        }
        for (int i = 0; i < DIM; i++) {
            TEST_ASSERT_TRUE(farthest[i] <= spreads[k] * 1.00001F && farthest[i] > spreads[k] * 0.7F);
        }
    }
}

static void test_without_seeds_the_whole_box_is_filled(void) {
    for (int k = 0; k < 2; k++) {
        if (k == 1) {
            use_binary(0);
        }
        cfg.population = POPULATION_MAX;
        ask_first_population();
        for (int i = 0; i < DIM; i++) {
            float least = hi[i], most = lo[i];
            for (int point = 0; point < POPULATION_MAX; point++) {
                least = fminf(least, asked[point][i]);
                most = fmaxf(most, asked[point][i]);
            }
            TEST_ASSERT_TRUE(most - least > 0.9F * (hi[i] - lo[i]));
        }
    }
}

static void test_result_is_never_worse_than_a_seed_for_200_of_200_seeds(void) {
    const float seeds[2][DIM] = {{0.0F, 0.0F, 1.0F}, {0.26F, -1.49F, 4.99F}};
    cfg.seeds = seeds[0];
    cfg.seed_count = 2;
    cfg.value_goal = -INFINITY;
    for (cfg.elite = 0; cfg.elite < 3; cfg.elite++) {
        for (cfg.seed = 0; cfg.seed < 200; cfg.seed++) {
            cfg.generation_max = 2;
            TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(7));
            TEST_ASSERT_TRUE(bowl_value(best()) <= bowl_value(seeds[1]));
        }
    }
}

// ---- breeding

// Runs to the middle of a generation; the parents are then all known, the children up to `next`.
static void run_into_generation(uint32_t generation, uint16_t point) {
    cfg.value_goal = -INFINITY;
    cfg.generation_max = generation;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_ga_start(&ga, &cfg));
    while (!(ga.generation == generation && ga.next == point)) {
        (void)aisle_ga_step(&ga, 1);
    }
}

static bool is_parent(uint32_t child, uint32_t parent) {
    return memcmp(ga.child + (size_t)child * cfg.genes, ga.parent + (size_t)parent * cfg.genes,
                  cfg.genes * sizeof(aisle_ga_gene)) == 0;
}

static void test_the_best_live_on_and_breed_more_than_the_rest(void) {
    cfg.pc = 0.0F;
    cfg.pm = 0.0F;
    for (cfg.seed = 0; cfg.seed < 50; cfg.seed++) {
        cfg.elite = (uint16_t)(1U + cfg.seed % 5U);
        run_into_generation(1, cfg.population);
        uint32_t worse = 0;
        for (uint32_t k = 0; k < cfg.population; k++) {
            uint32_t of = 0;
            while (!is_parent(k, ga.order[of])) {
                of++; // without crossover and mutation each child is a parent
                TEST_ASSERT_TRUE(of < cfg.population);
            }
            TEST_ASSERT_TRUE(k >= cfg.elite || of == k);
            worse += of >= cfg.population / 2U;
        }
        TEST_ASSERT_TRUE(worse > 0 && worse < cfg.population / 2U); // a quarter is expected of a tournament of two
    }
}

static void test_only_so_many_parents_breed(void) {
    cfg.pc = 0.0F;
    cfg.pm = 0.0F;
    cfg.parents = 10;
    run_into_generation(1, cfg.population);
    for (uint32_t k = 0; k < cfg.population; k++) {
        bool found = false;
        for (uint32_t of = 0; of < 10; of++) {
            found = found || is_parent(k, ga.order[of]);
        }
        TEST_ASSERT_TRUE(found);
    }
}

// With pm 0: each bit of a pair of children is that of one of two parents, and together they have what these had.
static void test_uniform_crossover_swaps_bits_of_a_pair(void) {
    use_binary(1);
    cfg.pm = 0.0F;
    cfg.pc = 1.0F;
    run_into_generation(1, cfg.population);
    uint32_t swapped = 0, differ = 0;
    for (uint32_t k = cfg.elite; k + 1U < cfg.population; k += 2U) {
        const uint64_t a = ga.child[k * DIM].code, b = ga.child[(k + 1U) * DIM].code;
        bool found = false;
        for (uint32_t p = 0; p < cfg.population && !found; p++) {
            for (uint32_t q = 0; q < cfg.population && !found; q++) {
                const uint64_t c = ga.parent[p * DIM].code, d = ga.parent[q * DIM].code;
                found = (a ^ b) == (c ^ d) && (a & b) == (c & d);
                for (uint64_t odd = found ? c ^ d : 0U, took = a ^ c; odd != 0U; odd >>= 1U, took >>= 1U) {
                    differ += (uint32_t)(odd & 1U);
                    swapped += (uint32_t)(odd & took & 1U);
                }
            }
        }
        TEST_ASSERT_TRUE(found);
    }
    TEST_ASSERT_TRUE(differ > 200 && swapped * 10U > differ * 4U && swapped * 10U < differ * 6U);
}

static void test_blend_stays_within_the_span_and_half_of_it(void) {
    cfg.pm = 0.0F;
    cfg.pc = 1.0F;
    const float seeds[2][DIM] = {{0.1F, 0.0F, 2.0F}, {0.3F, 0.4F, 3.0F}};
    cfg.seeds = seeds[0];
    cfg.seed_count = cfg.population = 2; // no others
    cfg.elite = 0;
    float least[DIM] = {9.0F, 9.0F, 9.0F}, most[DIM] = {-9.0F, -9.0F, -9.0F};
    for (cfg.seed = 0; cfg.seed < 300; cfg.seed++) {
        run_into_generation(1, 2);
        for (int i = 0; i < 2 * DIM; i++) {
            least[i % DIM] = fminf(least[i % DIM], ga.child[i].x);
            most[i % DIM] = fmaxf(most[i % DIM], ga.child[i].x);
        }
    }
    for (int i = 0; i < DIM; i++) {
        const float a = seeds[0][i], b = seeds[1][i], half = 0.5F * (b - a);
        TEST_ASSERT_TRUE(least[i] >= a - half - 1e-6F && least[i] < a - 0.8F * half);
        TEST_ASSERT_TRUE(most[i] <= b + half + 1e-6F && most[i] > b + 0.8F * half);
    }
}

// Genes, or bits, in which a child differs from the only parent there is.
static uint32_t mutated_of(uint32_t child) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < DIM; i++) {
        const aisle_ga_gene a = ga.child[child * DIM + i], b = ga.parent[i];
        if (cfg.coding == AISLE_GA_REAL) {
            count += a.x != b.x;
        } else {
            for (uint64_t x = a.code ^ b.code; x != 0U; x >>= 1U) {
                count += (uint32_t)(x & 1U);
            }
        }
    }
    return count;
}

static void expect_mutations(float pm, uint32_t most, float mean_of_child) {
    static float alike[POPULATION_MAX * DIM]; // all points, off the walls
    for (int i = 0; i < POPULATION_MAX * DIM; i++) {
        alike[i] = 0.4F;
    }
    cfg.seeds = alike;
    cfg.population = cfg.seed_count = POPULATION_MAX;
    cfg.elite = 0;
    cfg.pm = pm;
    uint32_t sum = 0, children = 0;
    for (cfg.seed = 0; cfg.seed < 40; cfg.seed++) {
        run_into_generation(1, POPULATION_MAX);
        for (uint32_t k = 0; k < POPULATION_MAX; k++, children++) {
            const uint32_t mutated = mutated_of(k);
            TEST_ASSERT_TRUE(mutated <= most);
            sum += mutated;
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.05F * mean_of_child, mean_of_child, (float)sum / (float)children);
}

static void test_mutations_are_as_many_as_stated(void) {
    expect_mutations(0.3F, DIM, 0.9F);
    cfg.redraw = true;
    expect_mutations(0.3F, DIM, 0.9F);
    cfg.mutation = AISLE_GA_ONE;
    expect_mutations(0.6F, 1, 0.6F);
    use_binary(1);
    expect_mutations(0.9F, 60, 54.0F);
    cfg.mutation = AISLE_GA_ONE;
    expect_mutations(0.9F, 1, 0.9F);
}

static void test_a_mutation_reaches_as_far_as_stated(void) {
    const float seeds[2][DIM] = {{0.0F, 0.0F, 2.5F}, {0.0F, 0.0F, 2.5F}};
    cfg.seeds = seeds[0];
    cfg.seed_count = cfg.population = 2;
    cfg.elite = 0;
    cfg.pm = 1.0F;
    const float reaches[3] = {0.0F, 0.02F, 0.4F};
    for (int k = 0; k < 3; k++) {
        const float reach = k == 0 ? 0.1F : reaches[k]; // the default
        float farthest = 0.0F;
        uint32_t small = 0;
        cfg.reach = reaches[k];
        for (cfg.seed = 0; cfg.seed < 300; cfg.seed++) {
            run_into_generation(1, 2);
            const float off = fabsf(ga.child[1].x) / 4.0F; // of the second gene's span
            farthest = fmaxf(farthest, off);
            small += off < reach / 256.0F;
        }
        TEST_ASSERT_TRUE(farthest <= reach * 1.00001F && farthest > 0.7F * reach);
        TEST_ASSERT_TRUE(small > 100 && small < 200); // sizes 2^-8 and less are half of the sixteen
    }
}

// ---- costs

static void test_a_small_allowed_place_is_looked_for_at_random_until_seen(void) {
    float above = 0.05F; // some 1/600 of the box
    cfg.cost = bowl_with_a_nan_rim;
    cfg.cost_ctx = &above;
    cfg.generation_max = 400;
    TEST_ASSERT_EQUAL_UINT32(100, hits_of(100));
    TEST_ASSERT_TRUE(ga.nan_costs > 0 && ga.nan_costs < ga.evals);
}

// ---- the run

static void test_generations_and_evaluations_are_as_many_as_stated(void) {
    cfg.value_goal = -INFINITY;
    cfg.generation_max = 12;
    calls = 0;
    TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(UINT32_MAX));
    TEST_ASSERT_EQUAL_UINT32(12, ga.generation);
    TEST_ASSERT_EQUAL_UINT32(40 + 12 * 38, ga.evals); // the elite is not asked about again
    TEST_ASSERT_EQUAL_UINT32(calls, ga.evals);
    TEST_ASSERT_TRUE(ga.best_updates > 5 && ga.best_updates < 200);
}

static void test_the_papers_parameters_are_the_papers(void) {
    const aisle_ga_config paper = aisle_ga_paper(5000);
    TEST_ASSERT_TRUE(paper.population == 80 && paper.bit == 40 && paper.generation_max == 5000 && paper.elite == 2);
    TEST_ASSERT_EQUAL_FLOAT(0.8F, paper.pc);
    TEST_ASSERT_EQUAL_FLOAT(0.9F, paper.pm);
    TEST_ASSERT_TRUE(paper.coding == AISLE_GA_BINARY && paper.crossover == AISLE_GA_UNIFORM);
}

static void expect_refusal(aisle_status with, const char *field) {
    static aisle_ga before;
    static unsigned char before_block[BYTES];
    memcpy(&before, &ga, sizeof ga);
    memcpy(before_block, block, BYTES);
    TEST_ASSERT_EQUAL_MESSAGE(with, aisle_ga_start(&ga, &cfg), field);
    TEST_ASSERT_EQUAL_MEMORY(&before, &ga, sizeof ga);
    TEST_ASSERT_EQUAL_MEMORY(before_block, block, BYTES);
}

static void expect_bad(const char *what) {
    expect_refusal(AISLE_ERR_ARG, what);
}

static void test_start_refuses_each_bad_field_and_leaves_everything_alone(void) {
    ga.evals = 77;
    const aisle_ga_config good = cfg;
#define REFUSE_WITH(status, field, value)                                                                              \
    cfg = good;                                                                                                        \
    cfg.field = (value);                                                                                               \
    expect_refusal(status, #field " = " #value)
#define REFUSE(field, value) REFUSE_WITH(AISLE_ERR_ARG, field, value)
    REFUSE(cost, NULL);
    REFUSE(lo, NULL);
    REFUSE(hi, NULL);
    REFUSE(genes, 0);
    REFUSE(genes, AISLE_GA_GENES_MAX + 1);
    REFUSE(population, 1);
    REFUSE(population, AISLE_GA_POPULATION_MAX + 1);
    REFUSE(generation_max, AISLE_GA_GENERATIONS_MAX + 1);
    REFUSE(elite, cfg.population);
    REFUSE(parents, cfg.population + 1);
    REFUSE(seed_count, 1);
    REFUSE(value_goal, NAN);
    REFUSE(spread, -0.1F);
    REFUSE(spread, NAN);
    REFUSE(spread, INFINITY);
    REFUSE(pc, -0.1F);
    REFUSE(pc, NAN);
    REFUSE(pc, 1.1F);
    REFUSE(pm, NAN);
    REFUSE(pm, 1.1F);
    REFUSE(reach, -1.0F);
    REFUSE(reach, NAN);
    REFUSE(coding, (aisle_ga_coding)2);
    REFUSE(coding, AISLE_GA_BINARY); // with BLEND and no bits
    REFUSE(crossover, (aisle_ga_crossover)2);
    REFUSE(mutation, (aisle_ga_mutation)2);
    REFUSE_WITH(AISLE_ERR_CAPACITY, population, POPULATION_MAX + 1);
    static const float low[GENES_MAX + 1], high[GENES_MAX + 1] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    cfg = good;
    cfg.lo = low;
    cfg.hi = high;
    cfg.genes = GENES_MAX + 1;
    expect_refusal(AISLE_ERR_CAPACITY, "genes");
    TEST_ASSERT_EQUAL(AISLE_ERR_ARG, aisle_ga_start(&ga, NULL));
    TEST_ASSERT_EQUAL_UINT32(77, ga.evals);
}

static void test_start_refuses_bad_binary_fields(void) {
    use_binary(1);
    const aisle_ga_config good = cfg;
    REFUSE(bit, 0);
    REFUSE(bit, AISLE_GA_BIT_MAX + 1);
    REFUSE(crossover, AISLE_GA_BLEND);
}

static void test_start_refuses_bad_seeds(void) {
    float seeds[2 * DIM] = {0};
    cfg.seeds = seeds;
    cfg.seed_count = 2;
    for (int at = 0; at < 2 * DIM; at++) {
        seeds[at] = at % 2 == 0 ? NAN : INFINITY;
        expect_bad("seed");
        seeds[at] = 0.0F;
    }
}

static void test_the_largest_box_and_spread_stay_finite(void) {
    const float seeds[DIM] = {1e30F, -1e30F, 0.0F};
    for (uint32_t way = 0; way < 8U; way++) {
        use_way(way);
        use_wide_box(DIM, 1e30F);
        cfg.seeds = seeds;
        cfg.seed_count = 1;
        cfg.spread = 1e30F;
        cfg.reach = 1.0F;
        cfg.pc = cfg.pm = 1.0F;
        cfg.cost = always;
        answer = (aisle_cost_pair){0.0F, 1.0F};
        TEST_ASSERT_EQUAL(AISLE_PARTIAL, run_in_steps_of(100)); // expect_in_box() refuses NaN
    }
}

static void test_invariants_notice_spoilt_fields(void) {
    cfg.value_goal = -INFINITY;
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_ga_start(&ga, &cfg));
    (void)aisle_ga_step(&ga, 200);
    const aisle_ga good = ga;
#define SPOIL(field, value)                                                                                            \
    ga.field = (value);                                                                                                \
    TEST_ASSERT_FALSE_MESSAGE(aisle_ga_invariants_hold(&ga), #field " = " #value);                                     \
    ga = good
    SPOIL(next, cfg.population + 1U);
    SPOIL(generation, cfg.generation_max + 1U);
    SPOIL(evals, aisle_ga_evals_max(&cfg) + 1U);
    SPOIL(nan_costs, 201);
    SPOIL(best_updates, 201);
    SPOIL(best_updates, 0);
    SPOIL(last_improvement, 201);
    SPOIL(best_cost.value, 1e9F);
    SPOIL(best_cost.value, NAN);
    SPOIL(ended, AISLE_OK);
#define SPOIL_AT(place, value)                                                                                         \
    do {                                                                                                               \
        const float was = (place);                                                                                     \
        (place) = (value);                                                                                             \
        TEST_ASSERT_FALSE_MESSAGE(aisle_ga_invariants_hold(&ga), #place " = " #value);                                 \
        (place) = was;                                                                                                 \
    } while (0)
    SPOIL_AT(ga.parent[4].x, NAN);
    SPOIL_AT(ga.parent[4].x, 99.0F);
    SPOIL_AT(ga.child[0].x, NAN);
    SPOIL_AT(ga.parent_cost[3].value, NAN);
    SPOIL_AT(ga.child_cost[0].violation, -1.0F);
    SPOIL_AT(ga.best[1], NAN);
    ga.order[0] = 40;
    TEST_ASSERT_FALSE(aisle_ga_invariants_hold(&ga));
    ga.order[0] = ga.order[39];
    TEST_ASSERT_FALSE(aisle_ga_invariants_hold(&ga)); // the worst first
}

// Recorded once: any other compiler, option or board must give the same bits.
static void test_bits_are_those_of_every_other_board(void) {
    uint32_t crc = 0;
    for (uint64_t seed = 0; seed < 40; seed++) {
        use_way((uint32_t)(seed % 8U));
        cfg.seed = seed;
        cfg.cost = seed % 3 == 0 ? walled_bowl : bowl;
        (void)run_in_steps_of(33);
        crc = crc_with_best(crc);
    }
    TEST_ASSERT_EQUAL_HEX32(0x923312E5, crc);
}

int main(void) {
    UNITY_BEGIN();
    run_tests_of_both();
    RUN_TEST(test_minimum_on_the_wall_is_found_in_binary_for_100_of_100_seeds);
    RUN_TEST(test_rosenbrock_is_hit_for_100_of_100_seeds);
    RUN_TEST(test_rastrigin_is_hit_for_50_of_50_seeds);
    RUN_TEST(test_any_slicing_gives_the_same_bits);
    RUN_TEST(test_invariants_hold_after_every_evaluation);
    RUN_TEST(test_first_points_asked_about_are_the_seeds);
    RUN_TEST(test_binary_seeds_are_within_one_step_of_the_code);
    RUN_TEST(test_the_others_lie_within_the_spread_and_fill_it);
    RUN_TEST(test_without_seeds_the_whole_box_is_filled);
    RUN_TEST(test_result_is_never_worse_than_a_seed_for_200_of_200_seeds);
    RUN_TEST(test_the_best_live_on_and_breed_more_than_the_rest);
    RUN_TEST(test_only_so_many_parents_breed);
    RUN_TEST(test_uniform_crossover_swaps_bits_of_a_pair);
    RUN_TEST(test_blend_stays_within_the_span_and_half_of_it);
    RUN_TEST(test_mutations_are_as_many_as_stated);
    RUN_TEST(test_a_mutation_reaches_as_far_as_stated);
    RUN_TEST(test_a_small_allowed_place_is_looked_for_at_random_until_seen);
    RUN_TEST(test_generations_and_evaluations_are_as_many_as_stated);
    RUN_TEST(test_the_papers_parameters_are_the_papers);
    RUN_TEST(test_start_refuses_each_bad_field_and_leaves_everything_alone);
    RUN_TEST(test_start_refuses_bad_binary_fields);
    RUN_TEST(test_start_refuses_bad_seeds);
    RUN_TEST(test_the_largest_box_and_spread_stay_finite);
    RUN_TEST(test_invariants_notice_spoilt_fields);
    RUN_TEST(test_bits_are_those_of_every_other_board);
    return UNITY_END();
}
