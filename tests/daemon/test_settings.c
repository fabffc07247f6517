#include "daemon/settings.h" // first: proves that the header stands alone

#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char path[64];
static char message[AISLE_SETTINGS_MESSAGE_LEN];
static aisle_settings settings;

void setUp(void) {
    (void)snprintf(path, sizeof path, "/tmp/aisle_settings_XXXXXX");
    int fd = mkstemp(path);
    TEST_ASSERT_TRUE(fd >= 0);
    (void)close(fd);
    aisle_settings_defaults(&settings);
    memset(message, 'x', sizeof message - 1);
}
void tearDown(void) {
    (void)unlink(path);
}

static aisle_status read_bytes(const char *text, size_t length) {
    FILE *file = fopen(path, "w");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(length, fwrite(text, 1, length, file));
    TEST_ASSERT_EQUAL(0, fclose(file));
    return aisle_settings_read(&settings, path, message);
}
static aisle_status read_text(const char *text) {
    return read_bytes(text, strlen(text));
}

// The file is refused on that line, in one line that holds `part` and says what is allowed; settings stay as they were.
static void expect_refusal(const char *text, int line, const char *part) {
    char place[96];
    aisle_settings before;
    aisle_settings_defaults(&settings);
    before = settings;
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_ERR_DATA, read_text(text), text);
    (void)snprintf(place, sizeof place, "%s:%d: ", path, line);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(place, message, strlen(place), message);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, part), message);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(message, "; allowed: "), message);
    TEST_ASSERT_NULL(strchr(message, '\n'));
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings, sizeof before);
}

static void test_defaults_are_those_of_the_documents(void) {
    TEST_ASSERT_EQUAL_STRING("AISLE", settings.prefix);
    TEST_ASSERT_EQUAL_STRING("", settings.url);
    TEST_ASSERT_EQUAL_UINT32(4194304, settings.queue_bytes);
    TEST_ASSERT_EQUAL_FLOAT(5.0F, settings.status_hz);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, settings.diag_hz);
    TEST_ASSERT_FALSE(settings.mlock);
    TEST_ASSERT_TRUE(settings.remember);
    TEST_ASSERT_FALSE(settings.skip_unreachable);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, settings.shortest_lease); // the planner's own
    TEST_ASSERT_EQUAL_INT32(AISLE_WORK_UNITS_DEFAULT, settings.work_units);
    TEST_ASSERT_EQUAL_UINT32(0, settings.limits.cells);
    TEST_ASSERT_EQUAL_INT16(4, settings.vehicle.num_vertices);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, settings.vehicle.footprint[1][0]);
    TEST_ASSERT_EQUAL_DOUBLE(-0.35, settings.vehicle.footprint[1][1]);
    TEST_ASSERT_EQUAL_FLOAT(1.5F, settings.vehicle.v_max);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, settings.vehicle.margin);
}
static void test_empty_file_changes_nothing(void) {
    aisle_settings before = settings;
    TEST_ASSERT_EQUAL(AISLE_OK, read_text(""));
    TEST_ASSERT_EQUAL_STRING("", message);
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings, sizeof before);
}
static void test_every_key_is_read(void) {
    const char *text = "; comment\n# comment\n[bus]\nurl = udpm://239.255.76.67:7667?ttl=1 ; across hosts\nprefix=V_7\n"
                       "queue_bytes = 300000\n[planner]\nwork_units = 5000\nwork_units_per_slice = 77\nremember = no\n"
                       "skip_unreachable = yes\nshortest_lease = 0.375\n"
                       "[limits]\ncells=10000\npolygons=10\nvertices=100\nopen_nodes=2048\nrequests=3\ncached_paths=7\n"
                       "[daemon]\nstatus_hz = 10\ndiag_hz = 0.5\nmlock = yes\n"
                       "[vehicle]\nvehicle_revision = 9\ndrive = tricycle\n";
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_OK, read_text(text), message);
    TEST_ASSERT_EQUAL_STRING("udpm://239.255.76.67:7667?ttl=1", settings.url);
    TEST_ASSERT_EQUAL_STRING("V_7", settings.prefix);
    TEST_ASSERT_EQUAL_UINT32(300000, settings.queue_bytes);
    TEST_ASSERT_EQUAL_INT32(5000, settings.work_units);
    TEST_ASSERT_EQUAL_UINT32(77, settings.work_units_per_slice);
    TEST_ASSERT_EQUAL_UINT32(10000, settings.limits.cells);
    TEST_ASSERT_EQUAL_UINT32(10, settings.limits.polygons);
    TEST_ASSERT_EQUAL_UINT32(100, settings.limits.vertices);
    TEST_ASSERT_EQUAL_UINT32(2048, settings.limits.open_nodes);
    TEST_ASSERT_EQUAL_UINT32(3, settings.limits.requests);
    TEST_ASSERT_EQUAL_UINT32(7, settings.limits.cached_paths);
    TEST_ASSERT_FALSE(settings.remember);
    TEST_ASSERT_TRUE(settings.skip_unreachable);
    TEST_ASSERT_EQUAL_FLOAT(0.375F, settings.shortest_lease);
    TEST_ASSERT_EQUAL_FLOAT(10.0F, settings.status_hz);
    TEST_ASSERT_EQUAL_FLOAT(0.5F, settings.diag_hz);
    TEST_ASSERT_TRUE(settings.mlock);
    TEST_ASSERT_EQUAL_INT32(9, settings.vehicle.vehicle_revision);
    TEST_ASSERT_EQUAL_INT8(AISLE_VEHICLE_TRICYCLE, settings.vehicle.drive);
}
static void test_every_scalar_of_the_vehicle_is_read_into_its_own_member(void) {
    const char *text =
        "[vehicle]\nfootprint_radius=0.01\nv_max=0.02\nv_reverse_max=0.03\na_max=0.04\nd_max=0.05\n"
        "omega_max=0.06\nalpha_max=0.07\nlateral_a_max=0.08\ncurvature_max=0.09\nreaction_time=0.1\n"
        "margin=-0.11\ncreep_clearance=0.12\ncreep_speed=0.13\npose_timeout=0.14\nobstacles_timeout=0.15\n"
        "mass=16\nrolling_resistance=0.17\nidle_power=0.18\ndrive_efficiency=0.19\n";
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_OK, read_text(text), message);
    const aisle_vehicle_msg *v = &settings.vehicle;
    const float got[] = {v->footprint_radius,
                         v->v_max,
                         v->v_reverse_max,
                         v->a_max,
                         v->d_max,
                         v->omega_max,
                         v->alpha_max,
                         v->lateral_a_max,
                         v->curvature_max,
                         v->reaction_time,
                         -v->margin,
                         v->creep_clearance,
                         v->creep_speed,
                         v->pose_timeout,
                         v->obstacles_timeout,
                         v->mass / 100.0F,
                         v->rolling_resistance,
                         v->idle_power,
                         v->drive_efficiency};
    for (int i = 0; i < (int)(sizeof got / sizeof got[0]); i++) {
        TEST_ASSERT_FLOAT_WITHIN_MESSAGE(1e-6F, 0.01F * (float)(i + 1), got[i], "member out of order");
    }
}
static void test_zero_keeps_the_default_of_vehicle_values_and_limits(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, read_text("[vehicle]\nv_max = 0\nmargin = 0.0\n[limits]\ncells = 0\n"));
    TEST_ASSERT_EQUAL_FLOAT(1.5F, settings.vehicle.v_max);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, settings.vehicle.margin);
    TEST_ASSERT_EQUAL_UINT32(0, settings.limits.cells);
}
static void test_footprint_may_go_on_over_lines(void) {
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_OK, read_text("[vehicle]\nfootprint = -1 -1, 1 -1,\n  1.5 0,\n\t1 1, -1 1\n"),
                              message);
    TEST_ASSERT_EQUAL_INT16(5, settings.vehicle.num_vertices);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, settings.vehicle.footprint[2][0]);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, settings.vehicle.footprint[4][1]);
}
static void test_radius_alone_makes_a_disc_and_with_a_footprint_rounds_it(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, read_text("[vehicle]\nfootprint_radius = 0.3\n"));
    TEST_ASSERT_EQUAL_INT16(0, settings.vehicle.num_vertices);
    TEST_ASSERT_EQUAL(AISLE_OK, read_text("[vehicle]\nfootprint_radius = 0.3\nfootprint = 0 0, 1 0, 0 1\n"));
    TEST_ASSERT_EQUAL_INT16(3, settings.vehicle.num_vertices);
}
static void test_unknown_sections_and_keys_are_told_with_their_line(void) {
    expect_refusal("[bus]\nprefix = A\n[buss]\n", 3, "unknown section [buss]");
    expect_refusal("\n\n[vehicles]\nmass = 1\n", 3, "unknown section [vehicles]");
    expect_refusal("[]\n", 1, "unknown section");
    expect_refusal("[bus]\n\nport = 7\n", 3, "unknown key \"port\" in [bus]; allowed: url, prefix, queue_bytes");
    expect_refusal("prefix = A\n", 1, "before any section");
    expect_refusal("[daemon]\nprefix = A\n", 2, "unknown key \"prefix\" in [daemon]");
}
static void test_duplicate_keys_are_told_with_both_lines(void) {
    expect_refusal("[bus]\nprefix = A\n[daemon]\nmlock = no\n[bus]\nprefix = A\n", 6, "set twice, first on line 2");
}
static void test_text_where_a_number_belongs_is_refused(void) {
    static const char *const bad[] = {"fast", "", "1.5m", "0x10", "inf", "nan", "1e999", "1,5", "1 2", "--1"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char text[64];
        (void)snprintf(text, sizeof text, "[vehicle]\nmass = 1\nv_max = %s\n", bad[i]);
        expect_refusal(text, 3, "is not a number; allowed: 0.01 to 20 m/s, or 0 for the default");
    }
    expect_refusal("[limits]\ncells = 5000.5\n", 2, "not a whole number; allowed: 4096 to 16777216");
}
static void test_numbers_out_of_range_are_refused_and_the_ends_are_taken(void) {
    expect_refusal("[limits]\ncells = 16777217\n", 2,
                   "[limits] cells = 16777217 is out of range; allowed: 4096 to 16777216");
    expect_refusal("[limits]\ncells = 4095\n", 2, "out of range");
    expect_refusal("[limits]\ncells = -1\n", 2, "out of range");
    expect_refusal("[daemon]\nstatus_hz = 51\n", 2, "allowed: 1 to 50 Hz");
    expect_refusal("[daemon]\nstatus_hz = 0\n", 2, "out of range");
    expect_refusal("[bus]\nqueue_bytes = 1\n", 2, "allowed: 262144 to 67108864 bytes");
    expect_refusal("[vehicle]\nmargin = 2.5\n", 2, "allowed: -1 to 2 m");
    expect_refusal("[vehicle]\nv_max = 1e300\n", 2, "out of range");
    TEST_ASSERT_EQUAL(AISLE_OK, read_text("[limits]\ncells = 16777216\nrequests = 64\n[daemon]\nstatus_hz = 50\n"));
    TEST_ASSERT_EQUAL_UINT32(16777216, settings.limits.cells);
}
static void test_the_shortest_lease_is_any_that_the_planner_takes(void) {
    static const char *const bad[] = {"0.0499", "1.01", "-0.125"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char text[64];
        (void)snprintf(text, sizeof text, "[planner]\nshortest_lease = %s\n", bad[i]);
        expect_refusal(text, 2, "out of range; allowed: 0.05 to 1 s, or 0 for the default");
    }
    expect_refusal("[planner]\nshortest_lease = nan\n", 2, "is not a number");
    expect_refusal("[daemon]\nshortest_lease = 0.5\n", 2, "unknown key \"shortest_lease\" in [daemon]");
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_OK, read_text("[planner]\nshortest_lease = 0.05\n"), message);
    TEST_ASSERT_TRUE(settings.shortest_lease >= 0.05F); // what the planner compares it with
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_OK, read_text("[planner]\nshortest_lease = 1\n"), message);
    TEST_ASSERT_TRUE(settings.shortest_lease <= 1.0F);
    aisle_settings_defaults(&settings);
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_OK, read_text("[planner]\nshortest_lease = 0\n"), message);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, settings.shortest_lease);
}
static void test_words_other_than_the_allowed_ones_are_refused(void) {
    expect_refusal("[daemon]\nmlock = maybe\n", 2, "neither yes nor no");
    expect_refusal("[vehicle]\ndrive = tank\n", 2, "allowed: differential, tricycle, omni");
    expect_refusal("[bus]\nprefix = A.*\n", 2, "allowed: 1 to 32 of A-Z a-z 0-9 _");
    expect_refusal("[bus]\nprefix =\n", 2, "not allowed");
    expect_refusal("[bus]\nprefix = A23456789012345678901234567890123\n", 2, "not allowed");
    expect_refusal("[bus]\nurl = 239.255.76.67\n", 2, "not an LCM address");
}
static void test_footprints_that_are_not_convex_outlines_are_refused(void) {
    expect_refusal("[vehicle]\nfootprint = 0 0, 1 0\n", 2, "has 2 points; allowed: 3 to 16");
    expect_refusal("[vehicle]\n\nfootprint =\n", 3, "has 0 points");
    expect_refusal("[vehicle]\nfootprint = 0 0, 0 1, 1 0\n", 2, "counter-clockwise");
    expect_refusal("[vehicle]\nfootprint = 0 0, 1 0, 2 0, 1 1\n", 2, "no three points in a line");
    expect_refusal("[vehicle]\nfootprint = 0 0, 2 0, 1 0.2, 1 2\n", 2, "convex");
    expect_refusal("[vehicle]\nfootprint = 0 1, -0.59 -0.81, 0.95 0.31, -0.95 0.31, 0.59 -0.81\n", 2,
                   "convex"); // a star
    expect_refusal("[vehicle]\nfootprint = 0 0, 1, 1 1\n", 2, "\" 1\" is not a point");
    expect_refusal("[vehicle]\nfootprint = 0 0, 1 0 0, 1 1\n", 2, "is not a point");
    expect_refusal("[vehicle]\nfootprint = 0 0, 21 0, 1 1\n", 2, "each -20 to 20 m");
    expect_refusal("[vehicle]\nfootprint = 0 0, nan 0, 1 1\n", 2, "is not a point");
    expect_refusal("[vehicle]\nfootprint = 0 0,1 0,1 1,\n 0 0,1 0,1 1,0 0,1 0,1 1,\n 0 0,1 0,1 1,0 0,1 0,1 1,0 0,1 0\n",
                   4, "too many points");
}
static void test_indented_key_does_not_go_unnoticed(void) {
    expect_refusal("[vehicle]\nmass = 5\n  v_max = 1\n", 3, "belongs to mass above");
}
static void test_lines_that_are_no_settings_are_refused(void) {
    expect_refusal("[bus]\nprefix\n", 2, "makes no sense");
    expect_refusal("[bus\nprefix = A\n", 1, "makes no sense");
    expect_refusal("[bus]\nprefix = A\n\377\376\n", 3, "makes no sense");
}
static void test_first_of_several_faults_is_told(void) {
    expect_refusal("[bus]\nprefix = ?\njunk\nfoo = 1\n", 2, "prefix");
    expect_refusal("[bus]\njunk\nprefix = ?\n", 2, "makes no sense");
}
static void test_line_too_long_or_with_zero_bytes_is_refused_not_cut(void) {
    char text[1024] = "[bus]\nurl = udpm://";
    size_t length = strlen(text);
    memset(text + length, '1', 300);
    (void)snprintf(text + length + 300, 32, "\nprefix = A\n");
    expect_refusal(text, 2, "line is too long");
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, read_bytes("[bus]\npre\0fix = A\n", 18));
    TEST_ASSERT_NOT_NULL(strstr(message, ":2: line is not text"));
}
static void test_missing_file_and_directory_are_told_without_a_line(void) {
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_settings_read(&settings, "/nowhere/aisled.ini", message));
    TEST_ASSERT_EQUAL_STRING("/nowhere/aisled.ini: cannot be read: No such file or directory", message);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_settings_read(&settings, "/tmp", message));
    TEST_ASSERT_NOT_NULL(strstr(message, "/tmp: cannot be read: "));
}
static void test_line_ends_of_other_systems_and_byte_order_marks_are_taken(void) {
    TEST_ASSERT_EQUAL_MESSAGE(AISLE_OK, read_text("\357\273\277[bus]\r\nprefix = CRLF\r\n"), message);
    TEST_ASSERT_EQUAL_STRING("CRLF", settings.prefix);
    TEST_ASSERT_EQUAL(AISLE_OK, read_text("[bus]\nprefix = NOEND"));
    TEST_ASSERT_EQUAL_STRING("NOEND", settings.prefix);
}
static void test_single_values_are_set_as_in_a_file(void) {
    TEST_ASSERT_EQUAL(AISLE_OK, aisle_settings_set(&settings, "bus", "prefix", "TRUCK", message));
    TEST_ASSERT_EQUAL_STRING("TRUCK", settings.prefix);
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_settings_set(&settings, "bus", "prefix", "a b", message));
    TEST_ASSERT_EQUAL_STRING("TRUCK", settings.prefix);
    TEST_ASSERT_NOT_NULL(strstr(message, "[bus] prefix = \"a b\" is not allowed"));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_settings_set(&settings, "bus", "no", "1", message));
    TEST_ASSERT_EQUAL(AISLE_ERR_DATA, aisle_settings_set(&settings, "vehicle", "footprint", "0 0, 0 1, 1 0", message));
    TEST_ASSERT_EQUAL_INT16(4, settings.vehicle.num_vertices);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_defaults_are_those_of_the_documents);
    RUN_TEST(test_empty_file_changes_nothing);
    RUN_TEST(test_every_key_is_read);
    RUN_TEST(test_every_scalar_of_the_vehicle_is_read_into_its_own_member);
    RUN_TEST(test_zero_keeps_the_default_of_vehicle_values_and_limits);
    RUN_TEST(test_footprint_may_go_on_over_lines);
    RUN_TEST(test_radius_alone_makes_a_disc_and_with_a_footprint_rounds_it);
    RUN_TEST(test_unknown_sections_and_keys_are_told_with_their_line);
    RUN_TEST(test_duplicate_keys_are_told_with_both_lines);
    RUN_TEST(test_text_where_a_number_belongs_is_refused);
    RUN_TEST(test_numbers_out_of_range_are_refused_and_the_ends_are_taken);
    RUN_TEST(test_the_shortest_lease_is_any_that_the_planner_takes);
    RUN_TEST(test_words_other_than_the_allowed_ones_are_refused);
    RUN_TEST(test_footprints_that_are_not_convex_outlines_are_refused);
    RUN_TEST(test_indented_key_does_not_go_unnoticed);
    RUN_TEST(test_lines_that_are_no_settings_are_refused);
    RUN_TEST(test_first_of_several_faults_is_told);
    RUN_TEST(test_line_too_long_or_with_zero_bytes_is_refused_not_cut);
    RUN_TEST(test_missing_file_and_directory_are_told_without_a_line);
    RUN_TEST(test_line_ends_of_other_systems_and_byte_order_marks_are_taken);
    RUN_TEST(test_single_values_are_set_as_in_a_file);
    return UNITY_END();
}
