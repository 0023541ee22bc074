"""servos.c: speed measurement, speed controllers and motor action of the two wheels.

The thesis calls Rl and Rr and prints neither.  CHOICE: each is a PI controller in volts with feed-forward and
anti-windup, whose integrator compares the wheel with what a sound wheel would do by now (a first-order model of the
motor), so that a step does not overshoot.  Feed-forward and model are the NXT motor's: Kb 0.468 V s/rad, R 6.69 ohm,
Kt 0.317 N m/A, friction 0.02 N m and 0.4 V in the bridge give 0.5 V s/rad and 0.8 V; the mechanical time constant is
some 70 ms.  At the supply's limit the integrator stands still and the model waits for the wheel.  A step to 11 rad/s
(0.3 m/s) settles in about 0.2 s.  CHOICE: a reference of exactly 0 brakes and forgets the integral, so that a stopped
robot does not creep.

CHOICE: drive and brake, the linear way: forward holds IN1 high and lets IN2 fall for the driven part of the period;
an action of 0 leaves both high, which is brake.  Actions go from -1 to 1, forward positive.
Sources: NXT, LB truth table, TFG section 3.2.3 (servo system), models of the parts.
"""

from __future__ import annotations

from emulator.c28x.language import *
from firmware_model.board_support.encoder import EDGES_PER_TURN, Encoder_left, Encoder_right
from firmware_model.board_support.pwm import Duty_EPWM2, Duty_EPWM7

TWO_PI = 6.2831853

KP = 0.4  # V s/rad
KI = 5.0  # V/rad
K_FORWARD = 0.5  # V s/rad
U_FRICTION = 0.8  # V
U_MAX = 7.2  # V
T_MODEL_S = 0.085

Servo_Period_s: float32 = 0.025
Model_Step: float32 = 0.25

Left_Position: int32 = 0
Right_Position: int32 = 0

Left_Integral: float32 = 0.0
Right_Integral: float32 = 0.0
Left_Model: float32 = 0.0
Right_Model: float32 = 0.0


# servos.c: Init_Servos
def Init_Servos(period_ms: uint16) -> void:

    Servo_Period_s = period_ms / 1000.0
    Model_Step = Servo_Period_s / (T_MODEL_S + Servo_Period_s / 2.0)
    Left_Position = Encoder_left()
    Right_Position = Encoder_right()
    Left_Integral = 0.0
    Right_Integral = 0.0
    Left_Model = 0.0
    Right_Model = 0.0


# servos.c: left_velocity
def left_velocity() -> float32:
    position: int32
    edges: int32

    position = Encoder_left()
    edges = position - Left_Position
    Left_Position = position
    return edges * (TWO_PI / EDGES_PER_TURN) / Servo_Period_s


# servos.c: right_velocity
def right_velocity() -> float32:
    position: int32
    edges: int32

    position = Encoder_right()
    edges = position - Right_Position
    Right_Position = position
    return edges * (TWO_PI / EDGES_PER_TURN) / Servo_Period_s


# servos.c: Wheel
def Wheel(ref: float32, w: float32, model: ptr[float32], integral: ptr[float32]) -> float32:
    err: float32
    u: float32

    if ref == 0.0:
        model[0] = w
        integral[0] = 0.0
        return 0.0

    err = model[0] - w
    model[0] = model[0] + Model_Step * (ref - model[0])

    u = K_FORWARD * ref + KP * err + integral[0]
    if ref > 0.0:
        u = u + U_FRICTION
    else:
        u = u - U_FRICTION

    if u > U_MAX:
        u = U_MAX
        model[0] = w
    elif u < -U_MAX:
        u = -U_MAX
        model[0] = w
    else:
        integral[0] = integral[0] + KI * Servo_Period_s * err

    return u / U_MAX


# servos.c: Rl
def Rl(ref: float32, w: float32) -> float32:
    return Wheel(ref, w, addressof(Left_Model), addressof(Left_Integral))


# servos.c: Rr
def Rr(ref: float32, w: float32) -> float32:
    return Wheel(ref, w, addressof(Right_Model), addressof(Right_Integral))


# servos.c: left_action
def left_action(U: float32) -> void:
    if U > 1.0:
        U = 1.0
    if U < -1.0:
        U = -1.0
    if U >= 0.0:
        Duty_EPWM2(1.0, 1.0 - U)
    else:
        Duty_EPWM2(1.0 + U, 1.0)


# servos.c: right_action
def right_action(U: float32) -> void:
    if U > 1.0:
        U = 1.0
    if U < -1.0:
        U = -1.0
    if U >= 0.0:
        Duty_EPWM7(1.0, 1.0 - U)
    else:
        Duty_EPWM7(1.0 + U, 1.0)
