#include "daemon/settings.h"

#include <errno.h>
#include <ini.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE_MAX_LEN 190 // inih's buffer is 200 by default and takes the line's end as well
#define FOOTPRINT_COORDINATE_MAX 20.0

enum { NAME_LEN = 48 };

typedef enum kind { KIND_URL, KIND_PREFIX, KIND_WHOLE, KIND_FLOAT, KIND_BOOL, KIND_DRIVE, KIND_FOOTPRINT } kind;

typedef struct key {
    const char *section, *name;
    size_t offset; // in aisle_settings
    double lo, hi; // of numbers
    const char *unit;
    kind kind;
    bool zero_is_default; // 0 leaves the value as it is
} key;

#define AT(member) offsetof(aisle_settings, member)
#define VEHICLE(member, lo, hi, unit)                                                                                  \
    { "vehicle", #member, AT(vehicle.member), lo, hi, unit, KIND_FLOAT, true }
#define LIMIT(member, lo, hi)                                                                                          \
    { "limits", #member, AT(limits.member), lo, hi, "", KIND_WHOLE, true }

// Numbers of KIND_WHOLE are 32-bit members; int32_t and uint32_t are written alike since lo >= 0 and hi <= INT32_MAX.
static const key keys[] = {
    {"bus", "url", AT(url), 0, 0, "", KIND_URL, false},
    {"bus", "prefix", AT(prefix), 0, 0, "", KIND_PREFIX, false},
    {"bus", "queue_bytes", AT(queue_bytes), 262144, 67108864, " bytes", KIND_WHOLE, false},
    {"planner", "work_units", AT(work_units), 1000, 2000000000, "", KIND_WHOLE, true},
    {"planner", "work_units_per_slice", AT(work_units_per_slice), 0, 1000000, " (0 = chosen)", KIND_WHOLE, false},
    {"planner", "remember", AT(remember), 0, 0, "", KIND_BOOL, false},
    {"planner", "skip_unreachable", AT(skip_unreachable), 0, 0, "", KIND_BOOL, false},
    {"planner", "shortest_lease", AT(shortest_lease), 0.05, 1, " s", KIND_FLOAT, true},
    LIMIT(cells, 4096, AISLE_LIMITS_CELLS_MAX),
    LIMIT(polygons, 1, 4096),
    LIMIT(vertices, 3, 65536),
    LIMIT(open_nodes, 1024, 4194304),
    LIMIT(requests, 1, 64),
    LIMIT(cached_paths, 1, 1024),
    {"vehicle", "vehicle_revision", AT(vehicle.vehicle_revision), 0, 2147483647, "", KIND_WHOLE, false},
    {"vehicle", "drive", AT(vehicle.drive), 0, 0, "", KIND_DRIVE, false},
    {"vehicle", "footprint", 0, 0, 0, "", KIND_FOOTPRINT, false},
    {"vehicle", "footprint_radius", AT(vehicle.footprint_radius), 0, 10, " m", KIND_FLOAT, false},
    VEHICLE(v_max, 0.01, 20, " m/s"),
    VEHICLE(v_reverse_max, 0.01, 20, " m/s"),
    VEHICLE(a_max, 0.01, 20, " m/s2"),
    VEHICLE(d_max, 0.01, 20, " m/s2"),
    VEHICLE(omega_max, 0.01, 20, " rad/s"),
    VEHICLE(alpha_max, 0.01, 100, " rad/s2"),
    VEHICLE(lateral_a_max, 0.01, 20, " m/s2"),
    {"vehicle", "curvature_max", AT(vehicle.curvature_max), 0, 100, " 1/m", KIND_FLOAT, false},
    VEHICLE(reaction_time, 0.001, 5, " s"),
    VEHICLE(margin, -1, 2, " m (negative = none)"),
    VEHICLE(creep_clearance, 0.001, 10, " m"),
    VEHICLE(creep_speed, 0.01, 20, " m/s"),
    VEHICLE(pose_timeout, 0.01, 10, " s"),
    VEHICLE(obstacles_timeout, 0.01, 10, " s"),
    VEHICLE(mass, 1, 1000000, " kg"),
    VEHICLE(rolling_resistance, 0.0001, 1, ""),
    VEHICLE(idle_power, 0.1, 1000000, " W"),
    VEHICLE(drive_efficiency, 0.01, 1, ""),
    {"daemon", "status_hz", AT(status_hz), 1, 50, " Hz", KIND_FLOAT, false},
    {"daemon", "diag_hz", AT(diag_hz), 0.1, 10, " Hz", KIND_FLOAT, false},
    {"daemon", "mlock", AT(mlock), 0, 0, "", KIND_BOOL, false},
};
enum { KEYS = sizeof keys / sizeof keys[0] };
static const char *const drives[] = {"differential", "tricycle", "omni"}; // AISLE_VEHICLE_DIFFERENTIAL, ...

// State of reading one file. Line numbers come from the reader, for Debian's inih does not hand them to the handler.
typedef struct reading {
    aisle_settings settings;
    FILE *file;
    const char *path;
    char *message;    // "" = nothing wrong so far
    int message_line; // of it
    int line;         // last one read
    bool indented;    // that line starts with a blank
    char section[NAME_LEN];
    int key;            // of the last key read, or -1
    int seen[KEYS];     // line of each key, 0 = not yet
    bool footprint_own; // *settings' footprint comes from the file
} reading;

void aisle_settings_defaults(aisle_settings *self) {
    memset(self, 0, sizeof *self);
    memcpy(self->prefix, "AISLE", sizeof "AISLE");
    self->queue_bytes = 4194304;
    self->work_units = AISLE_WORK_UNITS_DEFAULT;
    self->remember = true;
    self->status_hz = 5.0F;
    self->diag_hz = 1.0F;
    static const double footprint[4][2] = {{-0.5, -0.35}, {0.5, -0.35}, {0.5, 0.35}, {-0.5, 0.35}};
    aisle_vehicle_msg *v = &self->vehicle;
    v->num_vertices = 4;
    memcpy(v->footprint, footprint, sizeof footprint);
    v->v_max = 1.5F;
    v->v_reverse_max = 0.3F;
    v->a_max = v->d_max = v->lateral_a_max = 0.5F;
    v->omega_max = v->alpha_max = 1.0F;
    v->reaction_time = 0.3F;
    v->margin = 0.10F;
    v->creep_clearance = 0.5F;
    v->creep_speed = 0.3F;
    v->pose_timeout = 0.2F;
    v->obstacles_timeout = 0.3F;
}

// Writes the text and answers AISLE_ERR_DATA.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static aisle_status
refuse(char *message, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(message, AISLE_SETTINGS_MESSAGE_LEN, format, arguments);
    va_end(arguments);
    return AISLE_ERR_DATA;
}

// One decimal number and nothing else: no "inf", "nan", hexadecimal or trailing text.
static bool parse_number(const char *text, double *out) {
    if (*text == '\0' || text[strspn(text, "+-.0123456789eE")] != '\0') {
        return false;
    }
    char *end = NULL;
    errno = 0;
    *out = strtod(text, &end);
    return *end == '\0' && end != text && isfinite(*out);
}

static aisle_status set_number(void *member, const key *k, const char *value, char *message) {
    double number = 0.0;
    bool zero = k->zero_is_default;
    const char *or_zero = zero ? ", or 0 for the default" : "";
    const char *what = k->kind == KIND_WHOLE ? "a whole number" : "a number";
    bool ok = parse_number(value, &number);
    if (ok && k->kind == KIND_WHOLE && fabs(number - floor(number)) > 0.0) {
        ok = false;
    }
    if (!ok) {
        return refuse(message, "[%s] %s = \"%.40s\" is not %s; allowed: %.10g to %.10g%s%s", k->section, k->name, value,
                      what, k->lo, k->hi, k->unit, or_zero);
    }
    if (zero && fabs(number) <= 0.0) {
        return AISLE_OK;
    }
    if (number < k->lo || number > k->hi) {
        return refuse(message, "[%s] %s = %.40s is out of range; allowed: %.10g to %.10g%s%s", k->section, k->name,
                      value, k->lo, k->hi, k->unit, or_zero);
    }
    if (k->kind == KIND_WHOLE) {
        uint32_t whole = (uint32_t)number;
        memcpy(member, &whole, sizeof whole);
    } else {
        float real = (float)number;
        memcpy(member, &real, sizeof real);
    }
    return AISLE_OK;
}

static aisle_status set_url(char *member, const char *value, char *message) {
    static const char *const providers[] = {"udpm://", "memq://", "tcpq://", "file://"};
    bool known = *value == '\0';
    for (size_t i = 0; i < sizeof providers / sizeof providers[0]; i++) {
        known = known || strncmp(value, providers[i], strlen(providers[i])) == 0;
    }
    if (!known || strlen(value) > AISLE_SETTINGS_URL_MAX) {
        return refuse(message,
                      "[bus] url = \"%.80s\" is not an LCM address; allowed: at most %d characters, as in "
                      "udpm://239.255.76.67:7667?ttl=1, or nothing for LCM's default",
                      value, AISLE_SETTINGS_URL_MAX);
    }
    memcpy(member, value, strlen(value) + 1);
    return AISLE_OK;
}

// LCM reads a channel to subscribe as a regular expression, hence no other characters.
static aisle_status set_prefix(char *member, const char *value, char *message) {
    size_t length = strlen(value);
    static const char allowed[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
    if (length == 0 || length > AISLE_SETTINGS_PREFIX_MAX || strspn(value, allowed) != length) {
        return refuse(message, "[bus] prefix = \"%.80s\" is not allowed; allowed: 1 to %d of A-Z a-z 0-9 _", value,
                      AISLE_SETTINGS_PREFIX_MAX);
    }
    memcpy(member, value, length + 1);
    return AISLE_OK;
}

static aisle_status set_bool(bool *member, const key *k, const char *value, char *message) {
    static const char *const yes[] = {"true", "yes", "on", "1"}, *const no[] = {"false", "no", "off", "0"};
    for (size_t i = 0; i < sizeof yes / sizeof yes[0]; i++) {
        if (strcmp(value, yes[i]) == 0 || strcmp(value, no[i]) == 0) {
            *member = strcmp(value, yes[i]) == 0;
            return AISLE_OK;
        }
    }
    return refuse(message, "[%s] %s = \"%.40s\" is neither yes nor no; allowed: true yes on 1, false no off 0",
                  k->section, k->name, value);
}

static aisle_status set_drive(int8_t *member, const char *value, char *message) {
    for (size_t i = 0; i < sizeof drives / sizeof drives[0]; i++) {
        if (strcmp(value, drives[i]) == 0) {
            *member = (int8_t)i;
            return AISLE_OK;
        }
    }
    return refuse(message, "[vehicle] drive = \"%.40s\" is not known; allowed: differential, tricycle, omni", value);
}

// "x y" out of a copy of the text.
static bool parse_pair(char *text, double *pair) {
    static const char blank[] = " \t";
    char *rest = NULL;
    const char *x = strtok_r(text, blank, &rest), *y = strtok_r(NULL, blank, &rest);
    return x != NULL && y != NULL && strtok_r(NULL, blank, &rest) == NULL && parse_number(x, &pair[0]) &&
           parse_number(y, &pair[1]) && fabs(pair[0]) <= FOOTPRINT_COORDINATE_MAX &&
           fabs(pair[1]) <= FOOTPRINT_COORDINATE_MAX;
}

// Adds the points of one line to the footprint; a comma at the end is allowed, for the next line goes on.
static aisle_status add_footprint(aisle_vehicle_msg *vehicle, const char *value, char *message) {
    char text[LINE_MAX_LEN + 1], *rest = NULL;
    (void)snprintf(text, sizeof text, "%s", value);
    for (char *item = strtok_r(text, ",", &rest); item != NULL; item = strtok_r(NULL, ",", &rest)) {
        char shown[41];
        (void)snprintf(shown, sizeof shown, "%s", item);
        if (vehicle->num_vertices == AISLE_VEHICLE_MAX_VERTICES) {
            return refuse(message, "[vehicle] footprint has too many points; allowed: 3 to %d",
                          AISLE_VEHICLE_MAX_VERTICES);
        }
        if (!parse_pair(item, vehicle->footprint[vehicle->num_vertices])) {
            return refuse(message,
                          "[vehicle] footprint: \"%s\" is not a point; allowed: x y, x y, ... each -%g to %g m", shown,
                          FOOTPRINT_COORDINATE_MAX, FOOTPRINT_COORDINATE_MAX);
        }
        vehicle->num_vertices++;
    }
    return AISLE_OK;
}

// Strictly convex and counter-clockwise, exactly when every other vertex lies to the left of every edge.
static aisle_status check_footprint(const aisle_vehicle_msg *vehicle, char *message) {
    int n = vehicle->num_vertices;
    const double(*p)[2] = vehicle->footprint;
    if (n != 0 && n < 3) {
        return refuse(message, "[vehicle] footprint has %d points; allowed: 3 to %d", n, AISLE_VEHICLE_MAX_VERTICES);
    }
    for (int i = 0; i < n; i++) {
        int j = (i + 1) % n;
        for (int k = 0; k < n; k++) {
            double cross = (p[j][0] - p[i][0]) * (p[k][1] - p[i][1]) - (p[j][1] - p[i][1]) * (p[k][0] - p[i][0]);
            if (k != i && k != j && !(cross > 1e-9)) {
                return refuse(message,
                              "[vehicle] footprint: point %d is not left of the edge from point %d to %d; allowed: a "
                              "convex outline, counter-clockwise, no three points in a line",
                              k + 1, i + 1, j + 1);
            }
        }
    }
    return AISLE_OK;
}

static int find_key(const char *section, const char *name) {
    for (int i = 0; i < KEYS; i++) {
        if (strcmp(keys[i].section, section) == 0 && strcmp(keys[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static bool section_is_known(const char *section) {
    for (int i = 0; i < KEYS; i++) {
        if (strcmp(keys[i].section, section) == 0) {
            return true;
        }
    }
    return false;
}

static aisle_status set_value(aisle_settings *self, const key *k, const char *value, char *message) {
    void *member = (char *)self + k->offset;
    switch (k->kind) {
    case KIND_URL:
        return set_url(member, value, message);
    case KIND_PREFIX:
        return set_prefix(member, value, message);
    case KIND_BOOL:
        return set_bool(member, k, value, message);
    case KIND_DRIVE:
        return set_drive(member, value, message);
    case KIND_FOOTPRINT:
        return add_footprint(&self->vehicle, value, message);
    case KIND_WHOLE:
    case KIND_FLOAT:
    default:
        return set_number(member, k, value, message);
    }
}

// Keys of a section as "a, b, c".
static void list_keys(const char *section, char *out, size_t size) {
    size_t used = 0;
    out[0] = '\0';
    for (int i = 0; i < KEYS && used < size; i++) {
        if (strcmp(keys[i].section, section) == 0) {
            int n = snprintf(out + used, size - used, "%s%s", used == 0 ? "" : ", ", keys[i].name);
            used += n > 0 ? (size_t)n : 0;
        }
    }
}

static aisle_status unknown(const char *section, const char *name, char *message) {
    char names[400];
    if (*section == '\0') {
        return refuse(
            message, "\"%.40s\" stands before any section; allowed: [bus] [planner] [limits] [vehicle] [daemon]", name);
    }
    if (!section_is_known(section)) {
        return refuse(message, "unknown section [%.40s]; allowed: [bus] [planner] [limits] [vehicle] [daemon]",
                      section);
    }
    list_keys(section, names, sizeof names);
    return refuse(message, "unknown key \"%.40s\" in [%s]; allowed: %s", name, section, names);
}

// Remembers the first thing wrong, with its place in front.
static int report(reading *self, int line, const char *what) {
    if (self->message[0] == '\0') {
        (void)snprintf(self->message, AISLE_SETTINGS_MESSAGE_LEN, "%.120s:%d: %.380s", self->path, line, what);
        self->message_line = line;
    }
    return 0;
}

// The first line of a footprint replaces the built-in one.
static void start_key(reading *self, int index) {
    self->seen[index] = self->line;
    self->key = index;
    if (keys[index].kind == KIND_FOOTPRINT) {
        self->settings.vehicle.num_vertices = 0;
        memset(self->settings.vehicle.footprint, 0, sizeof self->settings.vehicle.footprint);
        self->footprint_own = true;
    }
}

// inih's handler: nonzero = taken. Also called, with the key above, for a line that starts with a blank.
static int on_value(void *user, const char *section, const char *name, const char *value) {
    reading *self = user;
    char what[AISLE_SETTINGS_MESSAGE_LEN];
    int index = find_key(section, name);
    if (index < 0) {
        (void)unknown(section, name, what);
        return report(self, self->line, what);
    }
    bool goes_on = self->indented && self->key == index && self->seen[index] != 0;
    if (goes_on && keys[index].kind != KIND_FOOTPRINT) {
        (void)refuse(what, "line starts with a blank and so belongs to %s above; allowed: keys at the line's start",
                     name);
        return report(self, self->line, what);
    }
    if (!goes_on && self->seen[index] != 0) {
        (void)refuse(what, "[%s] %s is set twice, first on line %d; allowed: once", section, name, self->seen[index]);
        return report(self, self->line, what);
    }
    if (!goes_on) {
        start_key(self, index);
    }
    return set_value(&self->settings, &keys[index], value, what) == AISLE_OK ? 1 : report(self, self->line, what);
}

// Unknown sections are told even when they hold no key.
static void check_section(reading *self, const char *text) {
    const char *end = strchr(text, ']');
    char what[AISLE_SETTINGS_MESSAGE_LEN];
    if (text[0] != '[' || end == NULL) {
        return;
    }
    size_t length = (size_t)(end - text) - 1;
    self->key = -1;
    (void)snprintf(self->section, sizeof self->section, "%.*s", length < NAME_LEN ? (int)length : NAME_LEN - 1,
                   text + 1);
    if (!section_is_known(self->section)) {
        (void)unknown(self->section[0] == '\0' ? "?" : self->section, "", what);
        (void)report(self, self->line, what);
    }
}

// inih's reader, as fgets: counts lines and refuses what does not fit a line instead of cutting it in two.
static char *read_line(char *text, int size, void *user) {
    reading *self = user;
    int limit = size - 3 < LINE_MAX_LEN ? size - 3 : LINE_MAX_LEN, length = 0, c = getc(self->file);
    if (c == EOF) {
        return NULL;
    }
    self->line++;
    bool odd = false;
    for (; c != EOF && c != '\n'; c = getc(self->file)) {
        odd = odd || c == '\0';
        if (length < limit) {
            text[length] = (char)c;
        }
        length++;
    }
    char what[AISLE_SETTINGS_MESSAGE_LEN];
    if (length > limit || odd) {
        (void)refuse(what, "%s; allowed: text of at most %d characters a line",
                     odd ? "line is not text" : "line is too long", limit);
        (void)report(self, self->line, what);
        length = 0;
    }
    text[length] = '\n';
    text[length + 1] = '\0';
    self->indented = text[0] == ' ' || text[0] == '\t';
    check_section(self, text);
    return text;
}

// What can be judged only when all is read. A radius without an outline means a disc, not a rounded default.
static aisle_status finish(reading *self) {
    int footprint = find_key("vehicle", "footprint"), radius = find_key("vehicle", "footprint_radius");
    if (!self->footprint_own && self->seen[radius] != 0 && self->settings.vehicle.footprint_radius > 0.0F) {
        self->settings.vehicle.num_vertices = 0;
    }
    char what[AISLE_SETTINGS_MESSAGE_LEN];
    if (self->footprint_own && self->settings.vehicle.num_vertices == 0) {
        (void)refuse(what, "[vehicle] footprint has 0 points; allowed: 3 to %d", AISLE_VEHICLE_MAX_VERTICES);
        (void)report(self, self->seen[footprint], what);
    } else if (check_footprint(&self->settings.vehicle, what) != AISLE_OK) {
        (void)report(self, self->seen[footprint], what);
    }
    return self->message[0] == '\0' ? AISLE_OK : AISLE_ERR_DATA;
}

aisle_status aisle_settings_read(aisle_settings *self, const char *path, char *message) {
    reading r = {.settings = *self, .path = path, .message = message, .key = -1};
    message[0] = '\0';
    r.file = fopen(path, "r");
    if (r.file == NULL) {
        return refuse(message, "%.120s: cannot be read: %s", path, strerror(errno));
    }
    int syntax = ini_parse_stream(read_line, &r, on_value, &r);
    bool failed = ferror(r.file) != 0;
    (void)fclose(r.file);
    if (failed) {
        return refuse(message, "%.120s: cannot be read: %s", path, strerror(errno));
    }
    if (syntax != 0 && (message[0] == '\0' || syntax < r.message_line)) {
        message[0] = '\0';
        (void)report(&r, syntax > 0 ? syntax : 1, "line makes no sense; allowed: [section], key = value, ; comment");
    }
    if (message[0] != '\0' || finish(&r) != AISLE_OK) {
        return AISLE_ERR_DATA;
    }
    *self = r.settings;
    return AISLE_OK;
}

aisle_status aisle_settings_set(aisle_settings *self, const char *section, const char *name, const char *value,
                                char *message) {
    int index = find_key(section, name);
    if (index < 0) {
        return unknown(section, name, message);
    }
    aisle_settings changed = *self;
    if (keys[index].kind == KIND_FOOTPRINT) {
        changed.vehicle.num_vertices = 0;
    }
    aisle_status status = set_value(&changed, &keys[index], value, message);
    if (status == AISLE_OK) {
        status = check_footprint(&changed.vehicle, message);
    }
    if (status == AISLE_OK) {
        *self = changed;
    }
    return status;
}
