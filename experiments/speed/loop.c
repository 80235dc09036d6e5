/* The push of affcli/simulation/pushing.py in C, on the same engine: what is left when Python costs nothing.
 *
 * The engine is the one that pymunk brings; its functions are found in its own library when this one is
 * loaded. A push begins just before contact, where the caller says: finding that out is not counted here.
 * Two ways to choose steps: all short ("the plain loop"), or those of affcli/simulation/pace.py.
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

typedef struct { double x, y; } Vect;
typedef struct { double a, b, c, d, tx, ty; } Transform;
typedef struct Space Space;
typedef struct Body Body;
typedef struct Shape Shape;
typedef struct Constraint Constraint;

Space *cpSpaceNew(void);
void cpSpaceFree(Space *);
void cpSpaceSetIterations(Space *, int);
void cpSpaceSetCollisionSlop(Space *, double);
void cpSpaceSetCollisionBias(Space *, double);
void cpSpaceSetCollisionPersistence(Space *, unsigned int);
void cpSpaceUseSpatialHash(Space *, double, int);
Body *cpSpaceGetStaticBody(Space *);
Body *cpSpaceAddBody(Space *, Body *);
Shape *cpSpaceAddShape(Space *, Shape *);
Constraint *cpSpaceAddConstraint(Space *, Constraint *);
void cpSpaceReindexShapesForBody(Space *, Body *);
void cpSpaceStep(Space *, double);
Body *cpBodyNew(double, double);
Body *cpBodyNewKinematic(void);
Vect cpBodyGetPosition(Body *);
Vect cpBodyGetVelocity(Body *);
double cpBodyGetAngle(Body *);
void cpBodySetPosition(Body *, Vect);
void cpBodySetVelocity(Body *, Vect);
void cpBodySetAngle(Body *, double);
void cpBodySetAngularVelocity(Body *, double);
Shape *cpCircleShapeNew(Body *, double, Vect);
Shape *cpPolyShapeNew(Body *, int, const Vect *, Transform, double);
void cpShapeSetFriction(Shape *, double);
Constraint *cpPivotJointNew2(Body *, Body *, Vect, Vect);
void cpConstraintSetMaxForce(Constraint *, double);
void cpConstraintSetMaxBias(Constraint *, double);

/* pace.py */
enum { STRIDE = 2, LOOK_AGAIN = 16, SETTLE = 8 };
static const double DEEP = 0.005, MARGIN = 1.5;
/* pushing.py */
enum { SETTLE_STEPS = 512 };
static const double REST_SPEED = 1e-6;
static const Vect FAR_AWAY = {1e3, 1e3};

typedef struct {
    double step, radius, mass, tool_friction, share, slop, bias;
    int iterations, parts, points;
    const double *boxes;  /* parts x (left, bottom, right, top) */
    const Vect *pivots;   /* points */
} Setup;

typedef struct {
    Vect puck;
    double angle;
    Vect wrist;           /* where the tool is when the push begins */
    Vect direction;
    int32_t first, count; /* its stretches */
} Push;

typedef struct { double speed; int64_t steps; } Stretch;
typedef struct { double x, y, angle; } Pose;

typedef struct {
    Setup setup;
    Space *space;
    Body *puck, *tool;
    Constraint **joints;
} World;

World *world_new(const Setup *setup) {
    World *w = malloc(sizeof *w);
    w->setup = *setup;
    w->space = cpSpaceNew();
    cpSpaceSetIterations(w->space, setup->iterations);
    cpSpaceSetCollisionSlop(w->space, setup->slop);
    cpSpaceSetCollisionBias(w->space, setup->bias);
    cpSpaceSetCollisionPersistence(w->space, 1);
    cpSpaceUseSpatialHash(w->space, 64.0, 16);
    Vect zero = {0.0, 0.0};
    Transform same = {1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    double r = setup->radius;
    w->puck = cpBodyNew(setup->mass, 0.5 * setup->mass * (r * r));
    w->tool = cpBodyNewKinematic();
    cpSpaceAddBody(w->space, w->puck);
    Shape *rim = cpSpaceAddShape(w->space, cpCircleShapeNew(w->puck, r, zero));
    cpShapeSetFriction(rim, 1.0);
    cpSpaceAddBody(w->space, w->tool);
    for (int i = 0; i < setup->parts; i++) {
        const double *b = setup->boxes + 4 * i;
        Vect corners[4] = {{b[0], b[1]}, {b[2], b[1]}, {b[2], b[3]}, {b[0], b[3]}};
        Shape *part = cpPolyShapeNew(w->tool, 4, corners, same, 0.0);
        cpShapeSetFriction(part, setup->tool_friction);
        cpSpaceAddShape(w->space, part);
    }
    w->joints = malloc(setup->points * sizeof *w->joints);
    for (int i = 0; i < setup->points; i++) {
        Body *table = cpSpaceGetStaticBody(w->space);
        Constraint *joint = cpPivotJointNew2(table, w->puck, zero, setup->pivots[i]);
        cpConstraintSetMaxForce(joint, setup->share);
        cpConstraintSetMaxBias(joint, 0.0);
        w->joints[i] = cpSpaceAddConstraint(w->space, joint);
    }
    return w;
}

static void place(World *w, Vect puck, double angle, Vect wrist) {
    Vect zero = {0.0, 0.0};
    cpBodySetAngle(w->puck, angle);
    cpBodySetPosition(w->puck, puck);
    cpBodySetVelocity(w->puck, zero);
    cpBodySetAngularVelocity(w->puck, 0.0);
    cpBodySetPosition(w->tool, wrist);
    cpBodySetVelocity(w->tool, zero);
    cpSpaceReindexShapesForBody(w->space, w->puck);
    cpSpaceReindexShapesForBody(w->space, w->tool);
}

static void lay_out(World *w, const Push *p) {
    place(w, FAR_AWAY, p->angle, p->wrist);
    for (int i = 0; i < w->setup.points; i++) cpConstraintSetMaxForce(w->joints[i], 0.0);
    cpSpaceStep(w->space, w->setup.step);
    for (int i = 0; i < w->setup.points; i++) cpConstraintSetMaxForce(w->joints[i], w->setup.share);
    place(w, p->puck, p->angle, p->wrist);
}

/* Pace.next, for tools whose parts are all boxes. */
static void next_steps(const World *w, double speed, int left, int *touched, int *stride, int *count) {
    Vect puck = cpBodyGetPosition(w->puck), tool = cpBodyGetPosition(w->tool);
    double x = puck.x - tool.x, y = puck.y - tool.y, overlap = 0.0, clearance = INFINITY;
    for (int i = 0; i < w->setup.parts; i++) {
        const double *b = w->setup.boxes + 4 * i;
        double dx = fmax(fmax(b[0] - x, 0.0), x - b[2]), dy = fmax(fmax(b[1] - y, 0.0), y - b[3]);
        double gap = hypot(dx, dy) - w->setup.radius;
        if (gap < 0.0) {
            if (overlap > 0.0) clearance = 0.0;
            overlap = fmax(overlap, -gap);
        } else {
            clearance = fmin(clearance, gap);
        }
    }
    int lasting = overlap > 0.0 && *touched;
    *touched = overlap > 0.0;
    *stride = 1;
    if (overlap > DEEP || (overlap > 0.0 && !lasting)) {
        *count = SETTLE < left ? SETTLE : left;
        return;
    }
    double most = fmin(fmin(clearance / (MARGIN * speed * w->setup.step), LOOK_AGAIN), left);
    int free_steps = (int)most;
    if (lasting && free_steps >= STRIDE) {
        *stride = STRIDE;
        *count = free_steps / STRIDE;
        return;
    }
    *count = free_steps > 1 ? free_steps : 1;
}

static Pose push(World *w, const Push *p, const Stretch *stretches, int paced, int64_t *steps) {
    double step = w->setup.step;
    int touched = 0;
    lay_out(w, p);
    for (int i = p->first; i < p->first + p->count; i++) {
        double speed = stretches[i].speed;
        Vect velocity = {speed * p->direction.x, speed * p->direction.y};
        cpBodySetVelocity(w->tool, velocity);
        for (int left = (int)stretches[i].steps; left > 0;) {
            int stride = 1, count = paced ? 1 : left;
            if (paced && left > 1) next_steps(w, speed, left, &touched, &stride, &count);
            left -= stride * count;
            *steps += count;
            for (int k = 0; k < count; k++) cpSpaceStep(w->space, stride * step);
        }
    }
    Vect zero = {0.0, 0.0};
    cpBodySetVelocity(w->tool, zero);
    for (int k = 0; k < SETTLE_STEPS; k++) {
        Vect v = cpBodyGetVelocity(w->puck);
        if (sqrt(v.x * v.x + v.y * v.y) < REST_SPEED) break;
        cpSpaceStep(w->space, step);
        ++*steps;
    }
    Vect at = cpBodyGetPosition(w->puck);
    Pose end = {at.x, at.y, cpBodyGetAngle(w->puck)};
    return end;
}

/* Do `n` pushes; return how many steps of the engine they took. */
int64_t push_all(World *w, const Push *pushes, int n, const Stretch *stretches, int paced, Pose *ends) {
    int64_t steps = 0;
    for (int i = 0; i < n; i++) ends[i] = push(w, &pushes[i], stretches, paced, &steps);
    return steps;
}
