"""main_Robot.c: the six tasks, navigation, the position controller, start-up.

`rectifica` and `Seacerca` are declared in the C and defined nowhere; nothing calls them.  The anonymous enumeration
of `EstadoNav` has a name here.  Sources: TFG sections 3.1 to 3.4, annex 1.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.sysbios.headers import (
    BIOS_WAIT_FOREVER,
    TRUE,
    BIOS_start,
    Clock_create,
    Clock_Handle,
    Clock_Params,
    Clock_Params_init,
    Log_write1,
    Semaphore_create,
    Semaphore_Handle,
    Semaphore_pend,
    Semaphore_post,
    Swi_create,
    Swi_Handle,
    Swi_Params,
    Swi_Params_init,
    Task_create,
    Task_Handle,
    Task_Params,
    Task_Params_init,
    UArg,
    UIABenchmark_start,
    UIABenchmark_stop,
)
from firmware_model.board_support.bumper import Init_Bumper, Read_Bumper
from firmware_model.board_support.clock import Get_Time, Init_Clock, Set_Timer
from firmware_model.board_support.encoder import Init_Encoder_left, Init_Encoder_right
from firmware_model.board_support.pwm import Init_EPWM2, Init_EPWM7
from firmware_model.board_support.servos import (
    Init_Servos,
    Rl,
    Rr,
    left_action,
    left_velocity,
    right_action,
    right_velocity,
)
from firmware_model.gyro import GYRO_SENSOR, Init_GYRO, Offset_GYRO, get_GYRO
from firmware_model.odometry import Odom_Trayect
from firmware_model.protocol import (
    Init_Protocol,
    Interpret_Order,
    Obtain_Reference,
    Read_Order,
    Received_Order,
    Send_ODO_Trayect,
)
from firmware_model.robot_types import ORDER, REFERENCE, STATUS, ODOMETRY_Trayect
from firmware_model.servidores import (
    Server_Create,
    read_front_distance,
    read_left_distance,
    read_ODO_Trayect,
    read_REF,
    read_right_distance,
    read_STATUS,
    read_T_REF,
    read_z_axis,
    write_front_distance,
    write_left_distance,
    write_ODO_Trayect,
    write_REF,
    write_right_distance,
    write_STATUS,
    write_T_REF,
    write_z_axis,
)
from firmware_model.us import US_SENSOR, Calibrate_US, Init_US, Read_Channel, Read_Distance

clockTaskUS: Clock_Handle
TaskUS_Handle: Task_Handle
TaskUS_sem: Semaphore_Handle

clockTaskGYRO: Clock_Handle
TaskGYRO_Handle: Task_Handle
TaskGYRO_sem: Semaphore_Handle

clockTaskNAVIGATION: Clock_Handle
TaskNAVIGATION_Handle: Task_Handle
TaskNAVIGATION_sem: Semaphore_Handle

clockTaskSERVO: Clock_Handle
TaskSERVO_Handle: Task_Handle
TaskSERVO_sem: Semaphore_Handle

TaskORD_Handle: Task_Handle
TaskORD_sem: Semaphore_Handle
mySwi: Swi_Handle

clockTaskODO: Clock_Handle
TaskODO_Handle: Task_Handle
TaskODO_sem: Semaphore_Handle

US_Period: const[uint16] = 5
GYRO_Period: const[uint16] = 5
Sevo_Period: const[uint16] = 25
Navigation_Period: const[uint16] = 50
Odometry_Period: const[uint16] = 250

caso: uint16 = 0
caso2: uint16 = 0
caso3: uint16 = 0
cuenta_gyro: uint16 = 0
Cuenta_US: int16 = 0

r: const[float32] = 0.027
d: const[float32] = 0.13
dhalf: const[float32] = 0.065
Tsw: const[float32] = 0.0025  # as in C: no task has this period
bumper: char

Robot_Reference_N: REFERENCE
Robot_Reference_S: REFERENCE
et_status: STATUS

dl: float32
df: float32
dr: float32
Left_distance: float32
Front_distance: float32
Right_distance: float32

odoT: ODOMETRY_Trayect = (0, 0, 0, 0, 0, 0)


class ESTADO_NAV(enum):
    INICIAL = 0
    SIGUE = 1
    FRENTE = 2
    IZQUIERDA = 3
    DERECHA = 4
    RODEADO = 5
    MARCHATRAS = 6
    SIGUEMUROS = 7


EstadoNav: ESTADO_NAV
Ti: uint16
siguiente: uint16
periodo: uint16
j: uint16

vX_b: float32
vY_b: float32
vZ_b: float32 = 0
wZ: float32 = 0
wZ_task: float32 = 0
Wpi: float32 = 0

kp: float32 = 0.5
ki: float32 = 0.01

kp_V: float32 = 0.1
ki_V: float32 = 0.001

kpx: float32 = 1
kix: float32 = 0.0001

Ix: ptr[float32] = NULL  # as in C: the five integrators point nowhere, that is, to address 0
Iw: ptr[float32] = NULL
Iwl: ptr[float32] = NULL
Iwr: ptr[float32] = NULL
Iv: ptr[float32] = NULL

tita_abs: float32 = 0
Wpos: float32 = 0
titaref: float32 = 0
Wl: float32 = 0
Wr: float32 = 0
Wl_ref: float32 = 0
Wr_ref: float32 = 0
Wl_ref_pi: float32 = 0
Wr_ref_pi: float32 = 0
U_l: float32 = 0
U_r: float32 = 0
Wabs: float32 = 0
Vl_T: float32 = 0
Vr_T: float32 = 0

Wciego: float32 = 0
d_ciegoL: float32 = 0
d_ciegoR: float32 = 0
cont: float32 = 0
alpha: float32 = 0

V_comp: float32 = 0
dF_ant: float32 = 0
V_pi: float32 = 0
hayComp: uint16 = 0


# main_Robot.c: main
def main() -> void:

    clockParams: Clock_Params
    taskParams: Task_Params

    swiParams: Swi_Params

    Clock_Params_init(addressof(clockParams))
    clockParams.period = US_Period
    clockParams.startFlag = TRUE
    clockTaskUS = Clock_create(TaskUS_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 255
    taskParams.priority = 6
    TaskUS_Handle = Task_create(TaskUS, addressof(taskParams), NULL)

    TaskUS_sem = Semaphore_create(0, NULL, NULL)

    Clock_Params_init(addressof(clockParams))
    clockParams.period = GYRO_Period
    clockParams.startFlag = TRUE
    clockTaskGYRO = Clock_create(TaskGYRO_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 255
    taskParams.priority = 5
    TaskGYRO_Handle = Task_create(TaskGYRO, addressof(taskParams), NULL)

    TaskGYRO_sem = Semaphore_create(0, NULL, NULL)

    Clock_Params_init(addressof(clockParams))
    clockParams.period = Navigation_Period
    clockParams.startFlag = TRUE
    clockTaskNAVIGATION = Clock_create(TaskNAVIGATION_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 1024
    taskParams.priority = 2
    TaskNAVIGATION_Handle = Task_create(TaskNAVIGATION, addressof(taskParams), NULL)

    TaskNAVIGATION_sem = Semaphore_create(0, NULL, NULL)

    Clock_Params_init(addressof(clockParams))
    clockParams.period = Sevo_Period
    clockParams.startFlag = TRUE
    clockTaskSERVO = Clock_create(TaskSERVO_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 512
    taskParams.priority = 3
    TaskSERVO_Handle = Task_create(TaskSERVO, addressof(taskParams), NULL)

    TaskSERVO_sem = Semaphore_create(0, NULL, NULL)

    Clock_Params_init(addressof(clockParams))
    clockParams.period = Odometry_Period
    clockParams.startFlag = TRUE
    clockTaskODO = Clock_create(TaskODO_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 512
    taskParams.priority = 1
    TaskODO_Handle = Task_create(TaskODO, addressof(taskParams), NULL)

    TaskODO_sem = Semaphore_create(0, NULL, NULL)

    Swi_Params_init(addressof(swiParams))
    swiParams.priority = 1
    mySwi = Swi_create(TaskORD_release, addressof(swiParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 512
    taskParams.priority = 4
    TaskORD_Handle = Task_create(TaskORD, addressof(taskParams), NULL)

    TaskORD_sem = Semaphore_create(0, NULL, NULL)

    Init_Protocol(mySwi)
    Init_Bumper()
    Init_Clock()
    siguiente = Get_Time()
    Set_Timer(5)
    Server_Create()

    BIOS_start()


# main_Robot.c: TaskUS_release
def TaskUS_release() -> void:
    Semaphore_post(TaskUS_sem)


# main_Robot.c: TaskUS
def TaskUS(a0: UArg, a1: UArg) -> void:

    Init_US()

    Calibrate_US(US_SENSOR.LEFT, 0.0551, 4.3516)
    Calibrate_US(US_SENSOR.RIGHT, 0.0569, 1.5336)
    Calibrate_US(US_SENSOR.FRONT, 0.0564, 2.3776)
    while 1:
        Semaphore_pend(TaskUS_sem, BIOS_WAIT_FOREVER)

        Left_distance = Read_Distance(US_SENSOR.LEFT)
        Front_distance = Read_Distance(US_SENSOR.FRONT)

        Right_distance = Read_Distance(US_SENSOR.RIGHT)

        write_left_distance(Left_distance)
        write_front_distance(Front_distance)
        write_right_distance(Right_distance)


# main_Robot.c: TaskGYRO_release
def TaskGYRO_release() -> void:
    Semaphore_post(TaskGYRO_sem)


# main_Robot.c: TaskGYRO
def TaskGYRO(a0: UArg, a1: UArg) -> void:

    Init_GYRO()
    vZ_b = Offset_GYRO(GYRO_SENSOR.Z)

    while 1:
        Semaphore_pend(TaskGYRO_sem, BIOS_WAIT_FOREVER)
        wZ_task = get_GYRO(GYRO_SENSOR.Z, vZ_b)

        write_z_axis(wZ_task)


# main_Robot.c: TaskNAVIGATION_release
def TaskNAVIGATION_release() -> void:
    Semaphore_post(TaskNAVIGATION_sem)


# main_Robot.c: TaskNAVIGATION
def TaskNAVIGATION(a0: UArg, a1: UArg) -> void:

    while 1:
        Semaphore_pend(TaskNAVIGATION_sem, BIOS_WAIT_FOREVER)
        Log_write1(UIABenchmark_start, "TaskNAV")
        df = read_front_distance()
        dl = read_left_distance()
        dr = read_right_distance()

        et_status = read_STATUS()

        bumper = Read_Bumper()

        wZ = read_z_axis()

        tita_abs = wZ * 0.005  # as in C: not accumulated

        if et_status == STATUS.STOP or bumper == 0:

            Action(0, 0)

            titaref = 0
        if et_status == STATUS.CALIBRATION or bumper == 0:

            Action(0, 0)
            CalibGyro(5)

            titaref = 0
        if et_status == STATUS.INITIALITATION or bumper == 0:  # as in C: a bump clears everything

            Action(0, 0)
            Inicializa()

            titaref = 0
        if et_status == STATUS.MISSION:
            EstadoNav = ESTADO_NAV.INICIAL

            titaref = 89
            MISION_4()

        if et_status == STATUS.TELEMANIPULATION:
            read_T_REF(addressof(Robot_Reference_N))
            write_REF(addressof(Robot_Reference_N))
            if bumper == 0:
                Action(0, 0)

        write_REF(addressof(Robot_Reference_N))
        Log_write1(UIABenchmark_stop, "TaskNAV")


# main_Robot.c: TaskSERVO_release
def TaskSERVO_release() -> void:
    Semaphore_post(TaskSERVO_sem)


# main_Robot.c: TaskSERVO
def TaskSERVO(a0: UArg, a1: UArg) -> void:
    Init_EPWM2()
    Init_EPWM7()

    Init_Encoder_right()
    Init_Encoder_left()

    Init_Servos(Sevo_Period)

    while 1:
        Semaphore_pend(TaskSERVO_sem, BIOS_WAIT_FOREVER)

        read_REF(addressof(Robot_Reference_S))

        Wl_ref = (Robot_Reference_S.V - Robot_Reference_S.W * dhalf) / r
        Wr_ref = (Robot_Reference_S.V + Robot_Reference_S.W * dhalf) / r

        Wl = left_velocity()
        U_l = Rl(Wl_ref, Wl)

        left_action(U_l)

        Wr = right_velocity()
        U_r = Rr(Wr_ref, Wr)

        right_action(U_r)


# main_Robot.c: TaskORD_release
def TaskORD_release() -> void:
    Semaphore_post(TaskORD_sem)


# main_Robot.c: TaskORD
def TaskORD(a0: UArg, a1: UArg) -> void:
    Order_frame: array[char, 200]  # as in C, if it compiled: the call cannot initialise an array
    Order: ORDER
    Local_ref: REFERENCE
    Received_Order()
    while 1:
        Semaphore_pend(TaskORD_sem, BIOS_WAIT_FOREVER)

        Read_Order(Order_frame)
        Order = Interpret_Order(Order_frame)

        match Order:
            case ORDER.O_STOP:
                write_STATUS(STATUS.STOP)

            case ORDER.O_MISSION:
                write_STATUS(STATUS.MISSION)

            case ORDER.O_TELEMANIPULATION:
                write_STATUS(STATUS.TELEMANIPULATION)

            case ORDER.O_SETR:
                Obtain_Reference(Order_frame, addressof(Local_ref))

                write_T_REF(addressof(Local_ref))
            case ORDER.O_CALIBRATION:
                write_STATUS(STATUS.CALIBRATION)

            case ORDER.O_INITIALITATION:
                write_STATUS(STATUS.INITIALITATION)

            case _:
                pass


# main_Robot.c: TaskODO_release
def TaskODO_release() -> void:
    Semaphore_post(TaskODO_sem)


# main_Robot.c: TaskODO
def TaskODO(a0: UArg, a1: UArg) -> void:

    while 1:
        Semaphore_pend(TaskODO_sem, BIOS_WAIT_FOREVER)

        read_ODO_Trayect(addressof(odoT))
        Odom_Trayect(addressof(odoT), Robot_Reference_N.V, Robot_Reference_N.W, df, dl, dr, Odometry_Period)
        write_ODO_Trayect(addressof(odoT))
        Send_ODO_Trayect(addressof(odoT))


# main_Robot.c: Action
def Action(V: float32, W: float32) -> void:
    Robot_Reference_N.V = V
    Robot_Reference_N.W = W


# main_Robot.c: MISION_4
def MISION_4() -> void:
    if bumper == 0:

        Position(0, 0)

        caso2 = caso2 + 1

        if caso2 > 60:
            Position(0, -0.1)

    else:
        if df < 45:

            Position(0, 0)
            EstadoNav = ESTADO_NAV.FRENTE

            if df < 25:
                caso2 = caso2 + 1
            else:
                caso = caso + 1

        elif df < 60:

            Position(0, 0.1)
            EstadoNav = ESTADO_NAV.SIGUE

            caso = 0
            caso2 = 0

            if dl < 30 and dr > 30:
                Position(-2, 0.1)
            if dr < 30 and dl > 30:
                Position(2, 0.1)

        else:

            Position(0, 0.15)
            EstadoNav = ESTADO_NAV.SIGUE

            caso = 0
            caso2 = 0

            if dl < 30 and dr > 30:
                Position(-2, 0.15)
            if dr < 30 and dl > 30:
                Position(2, 0.15)

    if caso > 60:

        EstadoNav = ESTADO_NAV.RODEADO

        if dl > dr:
            Position(89, 0.1)
            EstadoNav = ESTADO_NAV.IZQUIERDA

        elif dr > dl:
            Position(-89, 0.1)
            EstadoNav = ESTADO_NAV.DERECHA

    if caso2 > 60:

        Position(0, -0.1)


# main_Robot.c: PI
def PI(
    xref: float32,
    x: float32,
    kp: float32,
    ki: float32,
    xenc: ptr[float32],
    Umax: float32,
    Umin: float32,
) -> float32:

    err: float32
    pi: float32
    err = xref - x
    pi = (err * kp) + xenc[0]
    if pi > Umax:
        pi = Umax

    elif pi < Umin:
        pi = Umin
    else:
        xenc[0] = xenc[0] + ki * err * Tsw

    return pi


# main_Robot.c: Comp
def Comp(i: int16, dF_ant: float32) -> float32:
    dF_act: float32
    X: float32  # as in C: never initialised unless i > 50
    V: float32

    if i > 50:

        dF_act = float32(Read_Channel(1))  # as in C: counts, compared with centimetres
        X = (dF_act - dF_ant) / 100
    if X <= 0:
        V = 0
    else:

        V = X / 5

    return V


# main_Robot.c: CalibGyro
def CalibGyro(tiempo: float32) -> void:
    t: float32 = tiempo * 20
    if cuenta_gyro > t:

        vZ_b = Offset_GYRO(GYRO_SENSOR.Z)
        cuenta_gyro = 0
    else:
        cuenta_gyro += 1


# main_Robot.c: Lineal_velocity
def Lineal_velocity() -> void:

    if Cuenta_US < 10:
        dF_ant = read_front_distance()
    if Cuenta_US > 50:

        if ((25 < df) < 90) and (wZ <= 1):  # as in C: 25<df<90 compares a truth value with 90

            V_comp = Comp(Cuenta_US, dF_ant)

            hayComp = 1
        else:
            V_comp = 0
            Cuenta_US = 0
            hayComp = 0
        Cuenta_US = 0

    else:
        Cuenta_US += 1

    V_pi = PI(Robot_Reference_S.V, V_comp, kp_V, ki_V, Iv, 0.3, -0.3)
    Action(V_pi, 0)


# main_Robot.c: velocity
def velocity(Wref: float32, Vlineal: float32) -> void:
    Wpi: float32 = 0

    Wpi = PI(Robot_Reference_S.W, wZ, kp, ki, Iw, 0.5, -0.5)  # as in C: Wref is not used
    Action(Vlineal, Wpi)


# main_Robot.c: Position
def Position(titaref: float32, Vlineal: float32) -> void:
    tita_ref: float32
    Wpos: float32
    cont_pos: float32 = 0

    tita_ref = titaref * 0.0174

    cont_pos = cont_pos + 1  # as in C: a local, so it never gets beyond 1
    if cont_pos >= 60:
        Wpos = 0
        cont_pos = 0
    else:
        Wpos = PI(tita_ref, tita_abs, kpx, kix, Ix, 1.57, -1.57)

    Action(Vlineal, Wpos)


# main_Robot.c: P_ciego
def P_ciego(us: float32, t: int16, dmax: float32, dmin: float32) -> float32:
    d_act: float32 = 0
    d_ant: float32 = 0
    dt: float32
    temp: int16 = 0
    temp = t * 20

    if cont >= temp:

        cont = 0
    else:
        d_act = us
        cont += 1

    dt = (d_act - d_ant) / temp

    d_ant = d_act  # as in C: a local, forgotten at the return

    return dt


# main_Robot.c: Inicializa
def Inicializa() -> void:

    caso = 0
    caso2 = 0
    caso3 = 0
    cuenta_gyro = 0
    Cuenta_US = 0
    dl = 0
    df = 0
    dr = 0
    Left_distance = 0
    Front_distance = 0
    Right_distance = 0

    Ti = 0
    siguiente = 0
    periodo = 0
    j = 0

    vX_b = 0
    vY_b = 0
    vZ_b = 0  # as in C: the gyro's calibration is lost too
    wZ = 0
    Wabs = 0

    Ix = 0
    tita_abs = 0
    Wpos = 0
    titaref = 0
    Wl = 0
    Wr = 0
    Wl_ref = 0
    Wr_ref = 0
    U_l = 0
    U_r = 0

    Vl_T = 0
    Vr_T = 0

    Wciego = 0
    d_ciegoL = 0
    d_ciegoR = 0

    cont = 0
    alpha = 0

    V_comp = 0
    dF_ant = 0
    V_pi = 0
    hayComp = 0
