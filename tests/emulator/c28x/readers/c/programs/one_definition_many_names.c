// A structure, union or enumeration that is defined in a declaration of several names is one type for all of them.
// handle() == 7: MotorWare's `typedef struct {...} Obj, *Handle`
// objects() == 5: x = y copies, both are one type
// nameless() == 4: so are structures without a tag
// locals() == 6: in a block as well
// members() == 5: and as members
// enums() == 4: 1 + 3
// unions() == 9: through a pointer of the second name
// apart() == 5: the same tag in two blocks names two types: 2 + 3
typedef struct _motor_ { int speed; } MotorObj, *MotorHandle;
struct pair { int a; } x, y;
struct { int a; } p, q;
typedef enum { OFF, ON } mode, *mode_p;
enum { E1 = 1, E3 = 3 } e, f;
typedef union { int i; unsigned u; } *value_p, value;
struct outer { struct inner { int a; } i, j; } o;
static MotorObj motor;
int handle(void)
{
    MotorHandle h = &motor;
    h->speed = 7;
    return motor.speed;
}
int objects(void)
{
    y.a = 5;
    x = y;
    return x.a;
}
int nameless(void)
{
    p.a = 4;
    q = p;
    return q.a;
}
int locals(void)
{
    struct t { int a; } u = { 6 }, v;
    v = u;
    return v.a;
}
int members(void)
{
    o.i.a = 5;
    o.j = o.i;
    return o.j.a;
}
int enums(void)
{
    mode m = ON;
    mode_p n = &m;
    e = E3;
    f = e;
    return *n + f;
}
int unions(void)
{
    value v;
    value_p r = &v;
    r->i = 9;
    return v.u;
}
int apart(void)
{
    int sum = 0;
    {
        struct t { int a; } u = { 2 };
        sum += u.a;
    }
    {
        struct t { int b; } u = { 3 };
        sum += u.b;
    }
    return sum;
}
