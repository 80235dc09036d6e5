/* `in_equal_steps` of affcli/simulation/pushing.py in C, on the same engine: what is left when Python costs nothing.
 *
 * The engine is the one that pymunk brings; its functions are found in its own library when this one is
 * loaded. A push begins just before contact, where the caller says: finding that out is not counted here.
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
void cpConstraintSetErrorBias(Constraint *, double);

/* pushing.py */
static const double REST_SPEED = 1e-6, REST_SECONDS = 1.0;
static const Vect FAR_AWAY = {1e3, 1e3};

typedef struct {
    double step, radius, mass, tool_friction, share, slop, bias, gives_way;
    int iterations, parts, points;
    const double *boxes;  /* parts x (left, bottom, right, top) */
    const Vect *pivots;   /* points, on the puck */
    const Vect *arms;     /* points, on its counterpart */
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
    Body *puck, *tool, *counterpart;
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
    w->counterpart = cpBodyNew(setup->gives_way, 0.5 * setup->mass * (r * r));
    w->joints = malloc(setup->points * sizeof *w->joints);
    for (int i = 0; i < setup->points; i++) {
        Constraint *joint = cpPivotJointNew2(w->counterpart, w->puck, setup->arms[i], setup->pivots[i]);
        cpConstraintSetMaxForce(joint, setup->share);
        cpConstraintSetMaxBias(joint, 0.0);
        cpConstraintSetErrorBias(joint, 1.0);
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

static void align(World *w) {
    cpBodySetAngle(w->counterpart, cpBodyGetAngle(w->puck));
    cpBodySetAngularVelocity(w->counterpart, 0.0);
}

static void lay_out(World *w, const Push *p) {
    place(w, FAR_AWAY, p->angle, p->wrist);
    for (int i = 0; i < w->setup.points; i++) cpConstraintSetMaxForce(w->joints[i], 0.0);
    cpSpaceStep(w->space, w->setup.step);
    for (int i = 0; i < w->setup.points; i++) cpConstraintSetMaxForce(w->joints[i], w->setup.share);
    place(w, p->puck, p->angle, p->wrist);
    align(w);
    Vect zero = {0.0, 0.0};
    cpBodySetVelocity(w->counterpart, zero);
}

static Pose push(World *w, const Push *p, const Stretch *stretches, int64_t *steps) {
    double step = w->setup.step;
    lay_out(w, p);
    for (int i = p->first; i < p->first + p->count; i++) {
        double speed = stretches[i].speed;
        Vect velocity = {speed * p->direction.x, speed * p->direction.y};
        cpBodySetVelocity(w->tool, velocity);
        *steps += stretches[i].steps;
        for (int64_t k = 0; k < stretches[i].steps; k++) {
            cpSpaceStep(w->space, step);
            align(w);
        }
    }
    Vect zero = {0.0, 0.0};
    cpBodySetVelocity(w->tool, zero);
    for (double rested = 0.0; rested < REST_SECONDS; rested += step) {
        Vect v = cpBodyGetVelocity(w->puck);
        if (hypot(v.x, v.y) < REST_SPEED) break;
        cpSpaceStep(w->space, step);
        ++*steps;
    }
    Vect at = cpBodyGetPosition(w->puck);
    Pose end = {at.x, at.y, cpBodyGetAngle(w->puck)};
    return end;
}

/* Do `n` pushes; return how many steps of the engine they took. */
int64_t push_all(World *w, const Push *pushes, int n, const Stretch *stretches, Pose *ends) {
    int64_t steps = 0;
    for (int i = 0; i < n; i++) ends[i] = push(w, &pushes[i], stretches, &steps);
    return steps;
}
