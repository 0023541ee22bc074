"""main_Robot.c with its defects corrected, each where its id stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.c28x.language import *
from emulator.c28x.rts import fabs
from emulator.device_h import EALLOW, EDIS, DelayUs, GpioCtrlRegs, GpioDataRegs, ServiceDog, WdRegs
from emulator.sysbios.headers import (
    BIOS_WAIT_FOREVER,
    FALSE,
    TRUE,
    BIOS_start,
    Clock_create,
    Clock_Handle,
    Clock_Params,
    Clock_Params_init,
    Clock_start,
    GateMutexPri_create,
    GateMutexPri_enter,
    GateMutexPri_Handle,
    GateMutexPri_leave,
    GateMutexPri_Params,
    GateMutexPri_Params_init,
    IArg,
    Log_write1,
    Semaphore_create,
    Semaphore_getCount,
    Semaphore_pend,
    Swi_create,
    Swi_Params,
    Swi_Params_init,
    Task_create,
    Task_Params,
    Task_Params_init,
    Task_sleep,
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
from firmware_model.corrections.gyro import SPREAD_MOST, Gyro_Answers, Rested, Set_Up_Again
from firmware_model.gyro import GYRO_SENSOR, Init_GYRO, Offset_GYRO, get_GYRO, getZ
from firmware_model.main_robot import ESTADO_NAV
from firmware_model.odometry import Odom_Trayect
from firmware_model.protocol import (
    Init_Protocol,
    Interpret_Order,
    Obtain_Reference,
    Read_Order,
    Received_Order,
    Send_ODO_Trayect,
)
from firmware_model.robot_types import ORDER, REFERENCE, STATUS
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

if TYPE_CHECKING:
    from firmware_model.servidores import GYRO_server, Reference_server, ROBOT_Status, Status_server, US_server

RAD_PER_DEG: const[float32] = 0.01745329
SONAR_START_MS = 450  # calibration and first range of each of three sonars, and its settling

if FIXED("MAIN-us-period"):
    US_Period: const[uint16] = 150  # one round of the ring, 3 x 49 ms, has settled by then

if FIXED("MAIN-gyro-period"):
    GYRO_Period: const[uint16] = 10  # 100 Hz

if FIXED("MAIN-null-integrators"):
    Ix_Value: float32 = 0
    Ix: ptr[float32] = addressof(Ix_Value)
    if not FIXED("MAIN-speed-control-unused"):
        Iw_Value: float32 = 0
        Iv_Value: float32 = 0
        Iw: ptr[float32] = addressof(Iw_Value)
        Iv: ptr[float32] = addressof(Iv_Value)
    if not FIXED("MAIN-unused-objects"):
        Iwl_Value: float32 = 0
        Iwr_Value: float32 = 0
        Iwl: ptr[float32] = addressof(Iwl_Value)
        Iwr: ptr[float32] = addressof(Iwr_Value)

if FIXED("MAIN-kix-annex"):
    # Annex 4 found 10 with the integrator's step of 2.5 ms; with the true step of 50 ms that is 0.5.
    kix: float32 = 0.5 if FIXED("MAIN-pi-period") else 10.0

if FIXED("MAIN-titaref-unread"):
    del titaref

if FIXED("MAIN-hidden-names"):
    del kp, ki
    kp_W: float32 = 0.5
    ki_W: float32 = 0.01

if FIXED("MAIN-hidden-names"):
    del dF_ant
    dF_lineal: float32 = 0

if FIXED("MAIN-unused-objects"):
    del d, Iwl, Iwr, Wl_ref_pi, Wr_ref_pi

if FIXED("MAIN-pi-period"):
    del Tsw

# Calibration of the gyro: asked for by TaskNAVIGATION, done by TaskGYRO, behind GYRO_server.
CALIB_NOTHING = 0
CALIB_READ = 1
CALIB_FINISH = 2
CALIB_BEGIN = 3
CALIB_REST = 20  # periods of 50 ms: the wheels come to rest
Calib_Request: uint16 = 0
Calib_Sum: float32 = 0
Calib_Least: float32 = 0
Calib_Most: float32 = 0
Calib_Count: uint16 = 0

# Turned since TaskNAVIGATION and TaskODO last asked, behind GYRO_server; the way likewise, behind a gate
# of its own.
NAV_Turn_rad: float32 = 0
ODO_Turn_rad: float32 = 0
Way_server: GateMutexPri_Handle
Way_m: float32 = 0
ODO_Reset: uint16 = 0

# Navigation.
TURN_DONE_DEG = 3
if not FIXED("MAIN-speed-control-unused"):
    COMP_SPAN_S: const[float32] = 2.1  # 42 periods of 50 ms between the two distances
TURN_LIMIT = 120  # periods of 50 ms
REVERSE_LIMIT = 60  # 3 s, 30 cm
BUMP_REVERSE = 30  # 1.5 s, 15 cm
SIDE_CM = 30
SIDE_LIMIT_DEG = 20
NO_ECHO_CM = 600
NO_ECHO_PERIODS = 8
LEAN_DEG = 2
Turn_deg: float32 = 0
Turned_rad: float32 = 0
Turn_Count: uint16 = 0
Reverse_Count: uint16 = 0
Bumped: uint16 = 0
Lost_L: uint16 = 0
Lost_R: uint16 = 0
Lost_F: uint16 = 0
Heard: uint16 = 0
d_ciego_ant: float32 = 0
d_ciego_dt: float32 = 0
Ciego_Side: uint16 = 0

if FIXED("MAIN-position-count"):
    cont_pos: float32 = 0

# What the robot knows to be wrong.  A frame tells the number times -10 in the place of the front distance, in mm:
# no distance is negative.
SEEN_NOTHING = 0
SEEN_NO_DISTANCE = 1
SEEN_OLD_DISTANCE = 2
SEEN_FRONT_STUCK = 3
SEEN_GYRO_SILENT = 4
SEEN_TURN = 5
SEEN_WHEEL = 6
SEEN_LINK = 7
SEEN_BUMPER = 8
SEEN_PUSH = 9
LINK_PERIODS = 50  # 2.5 s: consoles repeat a reference each 0.1 s
FARTHEST_CM = 700  # 255 inches, as each of the three calibrations has them
US_PERIODS = 7  # of 50 ms: two rounds of the ring, and one period to be late
FRONT_WAY_M: const[float32] = 0.25  # ten of the sonar's inches
FRONT_STEP_CM = 2
GYRO_TURN_ON_MS = 300  # until its outputs are right, 250 ms by its data sheet
LATE_PERIODS = 16  # of 25 ms: a sound wheel has its speed within 0.2 s
TURN_DOUBT_RAD: const[float32] = 0.2
DOUBT_KEPT: const[float32] = 0.9  # a period of 50 ms: of a constant difference 0.5 s are left
PRESSED_PERIODS = 120  # 3 s standing, 3 s or 30 cm backwards
V_MOST: const[float32] = 0.3  # TFG 3.2.3
W_MOST: const[float32] = 1.57
Seen: uint16 = SEEN_NOTHING  # behind Status_server, as Link_Age
Link_Age: uint16 = 0
US_Age: uint16 = 0  # behind US_server
Gyro_Silent: uint16 = 0  # behind GYRO_server, as Doubt_rad
Doubt_rad: float32 = 0
Left_Late: uint16 = 0  # behind Reference_server, as the two that follow
Right_Late: uint16 = 0
Rolled_m: float32 = 0
Front_Before: float32 = 0
Front_Way_m: float32 = 0
Turn_Doubted: uint16 = 0
Wheel_Late: uint16 = 0
# What the motors are driven with (a share of their voltage) at a speed of the wheels in rad/s, on a floor, as measured.
EFFORT_REST: const[float32] = 0.163
EFFORT_W: const[float32] = 0.053
PUSH_SHARE: const[float32] = 1.2  # single samples are within 0.05; tyres that slip take 0.3 more
PUSH_MOST: const[float32] = 1.5  # more than tyres can take: the supply has fallen, or a wheel is held
PUSH_PERIODS = 12  # of 25 ms
SETTLE_PERIODS = 12
USUAL_PERIODS: const[float32] = 80.0  # 2 s: batteries run down slowly
Wl_Before: float32 = 0  # of TaskSERVO, as the three that follow
Settled: uint16 = 0
Usual_Effort: float32 = 0
Push_Count: uint16 = 0
Pushed: uint16 = 0  # behind Reference_server
Pushing: uint16 = 0
Pressed_Count: uint16 = 0

# The watchdog.  Releases that may wait: a task that has begun its turn has taken its own, one that hangs takes none.
clockWatch: Clock_Handle
WATCH_PERIOD = 50
WDCR_104_MS = 0x2C  # check bits 101, /8: 256 x 512 x 8 / 10 MHz = 104.9 ms
# The mean of fifty samples takes half a second where it is not spread over five.
GYRO_MOST = 9 if FIXED("MAIN-calib-span") else 120
NAV_MOST = 1 if FIXED("MAIN-calib-span") else 12
SERVO_MOST = 3
US_MOST = 1 if FIXED("MAIN-us-period") else 60
ODO_MOST = 1
ORD_MOST = 2  # periods of clockWatch in which an order waits
ORD_Age: uint16 = 0


# main_Robot.c: main
def main() -> void:

    clockParams: Clock_Params
    taskParams: Task_Params

    swiParams: Swi_Params
    if FIXED("MAIN-odo-commanded") or FIXED("MAIN-init-odometry"):
        gateParams: GateMutexPri_Params

    Clock_Params_init(addressof(clockParams))
    clockParams.period = US_Period
    clockParams.startFlag = FALSE if FIXED("MAIN-clock-before-task") else TRUE
    clockTaskUS = Clock_create(TaskUS_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 255
    taskParams.priority = 5 if FIXED("MAIN-us-period") else 6  # the longer period has the lower priority
    TaskUS_Handle = Task_create(TaskUS, addressof(taskParams), NULL)

    TaskUS_sem = Semaphore_create(0, NULL, NULL)

    Clock_Params_init(addressof(clockParams))
    clockParams.period = GYRO_Period
    clockParams.startFlag = FALSE if FIXED("MAIN-clock-before-task") else TRUE
    clockTaskGYRO = Clock_create(TaskGYRO_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 255
    taskParams.priority = 6 if FIXED("MAIN-us-period") else 5
    TaskGYRO_Handle = Task_create(TaskGYRO, addressof(taskParams), NULL)

    TaskGYRO_sem = Semaphore_create(0, NULL, NULL)

    Clock_Params_init(addressof(clockParams))
    clockParams.period = Navigation_Period
    clockParams.startFlag = FALSE if FIXED("MAIN-clock-before-task") else TRUE
    clockTaskNAVIGATION = Clock_create(TaskNAVIGATION_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 1024
    taskParams.priority = 2
    TaskNAVIGATION_Handle = Task_create(TaskNAVIGATION, addressof(taskParams), NULL)

    TaskNAVIGATION_sem = Semaphore_create(0, NULL, NULL)

    Clock_Params_init(addressof(clockParams))
    clockParams.period = Sevo_Period
    clockParams.startFlag = FALSE if FIXED("MAIN-clock-before-task") else TRUE
    clockTaskSERVO = Clock_create(TaskSERVO_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 512
    taskParams.priority = 3
    TaskSERVO_Handle = Task_create(TaskSERVO, addressof(taskParams), NULL)

    TaskSERVO_sem = Semaphore_create(0, NULL, NULL)

    Clock_Params_init(addressof(clockParams))
    clockParams.period = Odometry_Period
    clockParams.startFlag = FALSE if FIXED("MAIN-clock-before-task") else TRUE
    clockTaskODO = Clock_create(TaskODO_release, 10, addressof(clockParams), NULL)

    Task_Params_init(addressof(taskParams))
    taskParams.stackSize = 512
    taskParams.priority = 1
    TaskODO_Handle = Task_create(TaskODO, addressof(taskParams), NULL)

    TaskODO_sem = Semaphore_create(0, NULL, NULL)

    if FIXED("MAIN-watchdog"):
        Clock_Params_init(addressof(clockParams))
        clockParams.period = WATCH_PERIOD
        clockParams.startFlag = FALSE
        clockWatch = Clock_create(Watch, WATCH_PERIOD, addressof(clockParams), NULL)

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
    if FIXED("MAIN-odo-commanded") or FIXED("MAIN-init-odometry"):
        GateMutexPri_Params_init(addressof(gateParams))
        Way_server = GateMutexPri_create(addressof(gateParams), NULL)

    BIOS_start()


# main_Robot.c: TaskGYRO
def Arm_Watchdog() -> void:
    EALLOW()
    WdRegs.WDCR.all = WDCR_104_MS
    EDIS()
    ServiceDog()
    Clock_start(clockWatch)


# main_Robot.c: main
def Watch() -> void:
    ORD_Age = ORD_Age + 1 if Semaphore_getCount(TaskORD_sem) != 0 else 0
    if Semaphore_getCount(TaskGYRO_sem) > GYRO_MOST or Semaphore_getCount(TaskUS_sem) > US_MOST or ORD_Age > ORD_MOST:
        return
    if Semaphore_getCount(TaskSERVO_sem) > SERVO_MOST or Semaphore_getCount(TaskNAVIGATION_sem) > NAV_MOST:
        return
    if Semaphore_getCount(TaskODO_sem) > ODO_MOST:
        return
    ServiceDog()


# main_Robot.c: TaskUS
def TaskUS(a0: UArg, a1: UArg) -> void:

    Init_US()

    Calibrate_US(US_SENSOR.LEFT, 0.0551, 4.3516)
    Calibrate_US(US_SENSOR.RIGHT, 0.0569, 1.5336)
    Calibrate_US(US_SENSOR.FRONT, 0.0564, 2.3776)
    if FIXED("MAIN-us-period"):
        Hold_Ring()
    if FIXED("MAIN-us-first-read"):
        Task_sleep(SONAR_START_MS)
    if FIXED("MAIN-clock-before-task"):
        Clock_start(clockTaskUS)
    while 1:
        Semaphore_pend(TaskUS_sem, BIOS_WAIT_FOREVER)

        Left_distance = Read_Distance(US_SENSOR.LEFT)
        Front_distance = Read_Distance(US_SENSOR.FRONT)

        Right_distance = Read_Distance(US_SENSOR.RIGHT)

        write_left_distance(Left_distance)
        write_front_distance(Front_distance)
        write_right_distance(Right_distance)
        if FIXED("MAIN-distance-unchecked"):
            renew_US()
        if FIXED("MAIN-us-period"):
            Start_Ring()


# main_Robot.c: TaskUS
def Hold_Ring() -> void:
    EALLOW()
    GpioDataRegs.GPCDAT.bit.GPIO69 = 0
    GpioCtrlRegs.GPCDIR.bit.GPIO69 = 1  # wins against the 1 kOhm of the last TX: the ring stops when it is through
    EDIS()


# main_Robot.c: TaskUS
def Start_Ring() -> void:
    GpioDataRegs.GPCDAT.bit.GPIO69 = 1
    DelayUs(25)
    GpioDataRegs.GPCDAT.bit.GPIO69 = 0


# main_Robot.c: TaskGYRO
def TaskGYRO(a0: UArg, a1: UArg) -> void:
    if FIXED("MAIN-calib-task"):
        request: uint16
    if FIXED("GYRO-answer-unchecked"):
        silent: uint16
        settling: uint16 = 0
    Init_GYRO()
    vZ_b = Offset_GYRO(GYRO_SENSOR.Z)
    if FIXED("GYRO-offset-moving"):
        while not Rested:
            vZ_b = Offset_GYRO(GYRO_SENSOR.Z)

    if FIXED("MAIN-clock-before-task"):
        Clock_start(clockTaskGYRO)
        Clock_start(clockTaskNAVIGATION)  # nothing moves before the gyro's offset is known
    if FIXED("MAIN-watchdog"):
        Arm_Watchdog()
    while 1:
        Semaphore_pend(TaskGYRO_sem, BIOS_WAIT_FOREVER)
        if FIXED("GYRO-answer-unchecked"):
            silent = not Gyro_Answers()
            if silent:
                Set_Up_Again()  # it may have been reset
                settling = GYRO_TURN_ON_MS / GYRO_Period
            elif settling != 0:
                settling = settling - 1
                silent = 1
            wZ_task = 0
            if not silent:
                wZ_task = get_GYRO(GYRO_SENSOR.Z, vZ_b)
            write_Gyro_Silent(silent)
        else:
            wZ_task = get_GYRO(GYRO_SENSOR.Z, vZ_b)
        write_z_axis(wZ_task)

        if FIXED("MAIN-turn-unchecked"):
            add_Doubt(wZ_task * (GYRO_Period / 1000.0))
        if FIXED("MAIN-heading") or FIXED("MAIN-odo-commanded"):
            add_Turn(wZ_task * (GYRO_Period / 1000.0))
        if FIXED("MAIN-calib-task"):
            request = take_Calib_Request()
            if FIXED("MAIN-calib-span"):
                if request == CALIB_BEGIN:
                    begin_Calib()
                elif request == CALIB_READ:
                    add_Calib(getZ())
                elif request == CALIB_FINISH:
                    finish_Calib()
            elif request == CALIB_FINISH:
                measure_Offset()


# main_Robot.c: CalibGyro
def begin_Calib() -> void:
    Calib_Sum = 0
    Calib_Count = 0


# main_Robot.c: CalibGyro
def add_Calib(sample: int16) -> void:
    if FIXED("GYRO-offset-moving"):
        if Calib_Count == 0 or sample < Calib_Least:
            Calib_Least = sample
        if Calib_Count == 0 or sample > Calib_Most:
            Calib_Most = sample
    Calib_Sum = Calib_Sum + sample
    Calib_Count = Calib_Count + 1


# main_Robot.c: CalibGyro
def finish_Calib() -> void:
    if FIXED("GYRO-offset-moving"):
        if Calib_Count != 0 and Calib_Most - Calib_Least <= SPREAD_MOST:
            vZ_b = Calib_Sum / Calib_Count
    else:
        if Calib_Count != 0:
            vZ_b = Calib_Sum / Calib_Count


# main_Robot.c: CalibGyro
def measure_Offset() -> void:
    if FIXED("GYRO-offset-moving"):
        bias: float32

        bias = Offset_GYRO(GYRO_SENSOR.Z)
        if Rested:
            vZ_b = bias
    else:
        vZ_b = Offset_GYRO(GYRO_SENSOR.Z)


# main_Robot.c: CalibGyro
def write_Calib_Request(request: uint16) -> void:
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    Calib_Request = request
    GateMutexPri_leave(GYRO_server, key)


# main_Robot.c: CalibGyro
def take_Calib_Request() -> uint16:
    request: uint16
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    request = Calib_Request
    Calib_Request = CALIB_NOTHING
    GateMutexPri_leave(GYRO_server, key)
    return request


# main_Robot.c: TaskNAVIGATION
def TaskNAVIGATION(a0: UArg, a1: UArg) -> void:
    if FIXED("MAIN-link-silent") or FIXED("MAIN-distance-unchecked") or FIXED("MAIN-front-stuck") or FIXED("GYRO-answer-unchecked") or FIXED("MAIN-turn-unchecked") or FIXED("MAIN-wheel-unchecked") or FIXED("MAIN-bumper-stuck") or FIXED("MAIN-push-unnoticed"):  # noqa: E501
        seen: uint16

    while 1:
        Semaphore_pend(TaskNAVIGATION_sem, BIOS_WAIT_FOREVER)
        Log_write1(UIABenchmark_start, "TaskNAV")
        df = read_front_distance()
        dl = read_left_distance()
        dr = read_right_distance()

        et_status = read_STATUS()

        bumper = Read_Bumper()

        wZ = read_z_axis()

        if FIXED("MAIN-heading"):
            tita_abs = tita_abs + take_NAV_Turn()
        else:
            tita_abs = wZ * 0.005

        if FIXED("MAIN-calib-resumed"):
            if et_status != STATUS.CALIBRATION:
                cuenta_gyro = 0
        if FIXED("MAIN-link-silent") or FIXED("MAIN-distance-unchecked") or FIXED("MAIN-front-stuck") or FIXED("GYRO-answer-unchecked") or FIXED("MAIN-turn-unchecked") or FIXED("MAIN-wheel-unchecked") or FIXED("MAIN-bumper-stuck") or FIXED("MAIN-push-unnoticed"):  # noqa: E501
            seen = Look()
            if FIXED("MAIN-push-unnoticed"):
                write_Seen(Heed_Push(seen))
            else:
                write_Seen(seen)
        if et_status == STATUS.STOP or bumper == 0:

            Action(0, 0)

            if not FIXED("MAIN-titaref-unread"):
                titaref = 0
        if (
            et_status == STATUS.CALIBRATION
            if FIXED("MAIN-bump-clears")
            else et_status == STATUS.CALIBRATION or bumper == 0
        ):

            Action(0, 0)
            CalibGyro(5)

            if not FIXED("MAIN-titaref-unread"):
                titaref = 0
        if (
            et_status == STATUS.INITIALITATION
            if FIXED("MAIN-bump-clears")
            else et_status == STATUS.INITIALITATION or bumper == 0
        ):

            Action(0, 0)
            Inicializa()

            if not FIXED("MAIN-titaref-unread"):
                titaref = 0
        if FIXED("MAIN-mission-resumed"):
            if et_status != STATUS.MISSION:
                Begin_Mission()
        if et_status == STATUS.MISSION:
            if not FIXED("MAIN-state-reset"):
                EstadoNav = ESTADO_NAV.INICIAL

            if not FIXED("MAIN-titaref-unread"):
                titaref = 89
            if FIXED("MAIN-link-silent") or FIXED("MAIN-distance-unchecked") or FIXED("MAIN-front-stuck") or FIXED("GYRO-answer-unchecked") or FIXED("MAIN-turn-unchecked") or FIXED("MAIN-wheel-unchecked") or FIXED("MAIN-bumper-stuck") or FIXED("MAIN-push-unnoticed"):  # noqa: E501
                if seen == SEEN_NOTHING:
                    MISION_4()
                else:
                    Action(0, 0)
            else:
                MISION_4()

        if et_status == STATUS.TELEMANIPULATION:
            read_T_REF(addressof(Robot_Reference_N))
            if not FIXED("MAIN-tele-twice"):
                write_REF(addressof(Robot_Reference_N))
            if FIXED("MAIN-bump-holds"):
                if bumper == 0 and Robot_Reference_N.V > 0:
                    Action(0, 0)
            else:
                if bumper == 0:
                    Action(0, 0)

            if FIXED("MAIN-link-silent") or FIXED("MAIN-distance-unchecked") or FIXED("MAIN-front-stuck") or FIXED("GYRO-answer-unchecked") or FIXED("MAIN-turn-unchecked") or FIXED("MAIN-wheel-unchecked") or FIXED("MAIN-bumper-stuck") or FIXED("MAIN-push-unnoticed"):  # noqa: E501
                if seen != SEEN_NOTHING:
                    Action(0, 0)
        write_REF(addressof(Robot_Reference_N))
        Log_write1(UIABenchmark_stop, "TaskNAV")


# main_Robot.c: TaskNAVIGATION
def Look() -> uint16:
    seen: uint16 = SEEN_NOTHING

    if FIXED("MAIN-link-silent"):
        if age_Link() > LINK_PERIODS and et_status == STATUS.TELEMANIPULATION:
            seen = SEEN_LINK
    if FIXED("MAIN-distance-unchecked"):
        if age_US() > US_PERIODS and et_status == STATUS.MISSION:
            seen = SEEN_OLD_DISTANCE
        if et_status == STATUS.MISSION and not (Known(df) and Known(dl) and Known(dr)):
            seen = SEEN_NO_DISTANCE
    if FIXED("MAIN-front-stuck"):
        if Front_Stuck():
            seen = SEEN_FRONT_STUCK
    if FIXED("MAIN-bumper-stuck"):
        if et_status != STATUS.MISSION:
            Pressed_Count = 0
        if Pressed_Count == PRESSED_PERIODS and bumper == 0:
            seen = SEEN_BUMPER
    # Whether a wheel or the gyro is right shows only while the robot drives: this lasts until it is told to stand.
    if FIXED("MAIN-turn-unchecked"):
        if not Ordered_To_Drive():
            Turn_Doubted = 0
            take_Doubt(0)
        elif fabs(take_Doubt(DOUBT_KEPT)) > TURN_DOUBT_RAD:
            Turn_Doubted = 1
        if Turn_Doubted:
            seen = SEEN_TURN
    if FIXED("MAIN-wheel-unchecked"):
        if not Ordered_To_Drive():
            Wheel_Late = 0
        elif read_Late() > LATE_PERIODS:
            Wheel_Late = 1
        if Wheel_Late:
            seen = SEEN_WHEEL
    if FIXED("GYRO-answer-unchecked"):
        if read_Gyro_Silent() and et_status == STATUS.MISSION:
            seen = SEEN_GYRO_SILENT
    return seen


# main_Robot.c: TaskNAVIGATION
def Ordered_To_Drive() -> uint16:
    reference: REFERENCE

    if et_status == STATUS.TELEMANIPULATION:
        read_T_REF(addressof(reference))
        return reference.V != 0 or reference.W != 0
    return et_status == STATUS.MISSION


# main_Robot.c: TaskNAVIGATION
def Known(distance: float32) -> uint16:
    return distance >= 0 and distance <= FARTHEST_CM  # of what is no number neither is true


# main_Robot.c: TaskNAVIGATION
def Front_Stuck() -> uint16:
    Front_Way_m = Front_Way_m + fabs(take_Rolled())
    if et_status != STATUS.MISSION or df > NO_ECHO_CM or fabs(df - Front_Before) > FRONT_STEP_CM:
        Front_Before = df
        Front_Way_m = 0
    return Front_Way_m > FRONT_WAY_M


# main_Robot.c: TaskNAVIGATION
def write_Seen(seen: uint16) -> void:
    key: IArg

    key = GateMutexPri_enter(Status_server)
    Seen = seen
    GateMutexPri_leave(Status_server, key)


# main_Robot.c: TaskODO
def read_Seen() -> uint16:
    seen: uint16
    key: IArg

    key = GateMutexPri_enter(Status_server)
    seen = Seen
    GateMutexPri_leave(Status_server, key)
    return seen


# main_Robot.c: TaskORD
def renew_Link() -> void:
    key: IArg

    key = GateMutexPri_enter(Status_server)
    Link_Age = 0
    GateMutexPri_leave(Status_server, key)


# main_Robot.c: TaskNAVIGATION
def age_Link() -> uint16:
    age: uint16
    key: IArg

    key = GateMutexPri_enter(Status_server)
    if Link_Age <= LINK_PERIODS:
        Link_Age = Link_Age + 1
    age = Link_Age
    GateMutexPri_leave(Status_server, key)
    return age


# main_Robot.c: TaskUS
def renew_US() -> void:
    key: IArg

    key = GateMutexPri_enter(US_server)
    US_Age = 0
    GateMutexPri_leave(US_server, key)


# main_Robot.c: TaskNAVIGATION
def age_US() -> uint16:
    age: uint16
    key: IArg

    key = GateMutexPri_enter(US_server)
    if US_Age <= US_PERIODS:
        US_Age = US_Age + 1
    age = US_Age
    GateMutexPri_leave(US_server, key)
    return age


# main_Robot.c: TaskGYRO
def write_Gyro_Silent(silent: uint16) -> void:
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    Gyro_Silent = silent
    if FIXED("MAIN-turn-unchecked"):
        if silent:
            Doubt_rad = 0
    GateMutexPri_leave(GYRO_server, key)


# main_Robot.c: TaskNAVIGATION
def read_Gyro_Silent() -> uint16:
    silent: uint16
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    silent = Gyro_Silent
    GateMutexPri_leave(GYRO_server, key)
    return silent


# main_Robot.c: TaskGYRO, TaskSERVO
def add_Doubt(rad: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    Doubt_rad = Doubt_rad + rad
    GateMutexPri_leave(GYRO_server, key)


# main_Robot.c: TaskNAVIGATION
def take_Doubt(kept: float32) -> float32:
    rad: float32
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    rad = Doubt_rad
    Doubt_rad = Doubt_rad * kept
    GateMutexPri_leave(GYRO_server, key)
    return rad


# main_Robot.c: TaskSERVO
def note_Late() -> void:
    key: IArg

    key = GateMutexPri_enter(Reference_server)
    Left_Late = Left_Late + 1 if Stands_Still(Wl_ref, Wl) else 0
    Right_Late = Right_Late + 1 if Stands_Still(Wr_ref, Wr) else 0
    GateMutexPri_leave(Reference_server, key)


# main_Robot.c: TaskSERVO
def Stands_Still(ref: float32, w: float32) -> uint16:
    return fabs(ref) > 1 and w * ref < 0.1 * ref * ref


# main_Robot.c: TaskNAVIGATION
def read_Late() -> uint16:
    late: uint16
    key: IArg

    key = GateMutexPri_enter(Reference_server)
    late = Left_Late if Left_Late > Right_Late else Right_Late
    GateMutexPri_leave(Reference_server, key)
    return late


# main_Robot.c: TaskSERVO
def add_Rolled(way_m: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(Reference_server)
    Rolled_m = Rolled_m + way_m
    GateMutexPri_leave(Reference_server, key)


# main_Robot.c: TaskNAVIGATION
def take_Rolled() -> float32:
    way_m: float32
    key: IArg

    key = GateMutexPri_enter(Reference_server)
    way_m = Rolled_m
    Rolled_m = 0
    GateMutexPri_leave(Reference_server, key)
    return way_m


# main_Robot.c: TaskSERVO
def note_Push() -> void:
    effort: float32
    key: IArg

    if Wl_ref * Wr_ref < 1 or fabs(Wl_ref - Wl_Before) > 0.5:
        Settled = 0  # it stands, turns on the spot, or changes its speed
        Push_Count = 0
    Wl_Before = Wl_ref
    if Settled < SETTLE_PERIODS:
        Settled = Settled + 1
        return
    effort = (fabs(U_l) + fabs(U_r)) / (2 * EFFORT_REST + EFFORT_W * (fabs(Wl_ref) + fabs(Wr_ref)))
    if Usual_Effort == 0:
        Usual_Effort = effort
    if effort > PUSH_MOST * Usual_Effort:
        Usual_Effort = effort
    Usual_Effort = Usual_Effort + (effort - Usual_Effort) / USUAL_PERIODS
    Push_Count = Push_Count + 1 if effort > PUSH_SHARE * Usual_Effort else 0
    if Push_Count == PUSH_PERIODS:
        key = GateMutexPri_enter(Reference_server)
        Pushed = 1
        GateMutexPri_leave(Reference_server, key)


# main_Robot.c: TaskNAVIGATION
def take_Pushed() -> uint16:
    pushed: uint16
    key: IArg

    key = GateMutexPri_enter(Reference_server)
    pushed = Pushed
    Pushed = 0
    GateMutexPri_leave(Reference_server, key)
    return pushed


# main_Robot.c: TaskNAVIGATION
def Heed_Push(seen: uint16) -> uint16:
    if take_Pushed() and et_status == STATUS.MISSION:
        Pushing = 1
        Bumped = 1
        Reverse_Count = 0
        Turn_deg = 0
    if Bumped == 0:
        Pushing = 0
    return SEEN_PUSH if Pushing and seen == SEEN_NOTHING else seen


# main_Robot.c: TaskSERVO
def Limited(value: float32, limit: float32) -> float32:
    if value > limit:
        return limit
    if value < -limit:
        return -limit
    if value >= -limit:
        return value
    return 0.0  # it is no number


# main_Robot.c: TaskNAVIGATION
def Begin_Mission() -> void:
    caso = 0
    caso2 = 0
    tita_abs = 0
    Turn_deg = 0
    Reverse_Count = 0
    Bumped = 0
    Lost_L = 0
    Lost_R = 0
    Lost_F = 0
    Heard = 0
    Ix[0] = 0
    EstadoNav = ESTADO_NAV.INICIAL


# main_Robot.c: TaskSERVO
def TaskSERVO(a0: UArg, a1: UArg) -> void:
    Init_EPWM2()
    Init_EPWM7()

    Init_Encoder_right()
    Init_Encoder_left()

    Init_Servos(Sevo_Period)

    if FIXED("MAIN-clock-before-task"):
        Clock_start(clockTaskSERVO)
    while 1:
        Semaphore_pend(TaskSERVO_sem, BIOS_WAIT_FOREVER)

        read_REF(addressof(Robot_Reference_S))
        if FIXED("MAIN-actuator-limits"):
            Robot_Reference_S.V = Limited(Robot_Reference_S.V, V_MOST)
            Robot_Reference_S.W = Limited(Robot_Reference_S.W, W_MOST)

        Wl_ref = (Robot_Reference_S.V - Robot_Reference_S.W * dhalf) / r
        Wr_ref = (Robot_Reference_S.V + Robot_Reference_S.W * dhalf) / r

        Wl = left_velocity()
        U_l = Rl(Wl_ref, Wl)

        left_action(U_l)

        Wr = right_velocity()
        U_r = Rr(Wr_ref, Wr)

        right_action(U_r)

        if FIXED("MAIN-wheel-unchecked"):
            note_Late()
        if FIXED("MAIN-push-unnoticed"):
            note_Push()
        if FIXED("MAIN-turn-unchecked"):
            add_Doubt((Wl - Wr) / (2 * dhalf) * r * (Sevo_Period / 1000.0))
        if FIXED("MAIN-front-stuck"):
            add_Rolled((Wl + Wr) * 0.5 * r * (Sevo_Period / 1000.0))
        if FIXED("MAIN-odo-commanded"):
            add_Way((Wl + Wr) * 0.5 * r * (Sevo_Period / 1000.0))


# main_Robot.c: TaskGYRO
def add_Turn(rad: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    NAV_Turn_rad = NAV_Turn_rad + rad
    ODO_Turn_rad = ODO_Turn_rad + rad
    GateMutexPri_leave(GYRO_server, key)


# main_Robot.c: TaskNAVIGATION
def take_NAV_Turn() -> float32:
    rad: float32
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    rad = NAV_Turn_rad
    NAV_Turn_rad = 0
    GateMutexPri_leave(GYRO_server, key)
    return rad


# main_Robot.c: TaskODO
def take_ODO_Turn() -> float32:
    rad: float32
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    rad = ODO_Turn_rad
    ODO_Turn_rad = 0
    GateMutexPri_leave(GYRO_server, key)
    return rad


# main_Robot.c: TaskSERVO
def add_Way(way_m: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(Way_server)
    Way_m = Way_m + way_m
    GateMutexPri_leave(Way_server, key)


# main_Robot.c: TaskODO
def take_Way() -> float32:
    way_m: float32
    key: IArg

    key = GateMutexPri_enter(Way_server)
    way_m = Way_m
    Way_m = 0
    GateMutexPri_leave(Way_server, key)
    return way_m


# main_Robot.c: TaskORD
def TaskORD(a0: UArg, a1: UArg) -> void:
    Order_frame: array[char, 200]
    Order: ORDER
    Local_ref: REFERENCE
    if FIXED("MAIN-stop-keeps-reference") or FIXED("MAIN-init-reference") or FIXED("MAIN-reference-outlives"):
        Rest: REFERENCE = (0.0, 0.0)
    if not FIXED("MAIN-order-twice"):
        Received_Order()
    while 1:
        Semaphore_pend(TaskORD_sem, BIOS_WAIT_FOREVER)

        if FIXED("MAIN-order-twice"):
            if Received_Order() == 0:
                continue
        Read_Order(Order_frame)
        Order = Interpret_Order(Order_frame)
        if FIXED("MAIN-link-silent"):
            if Order != ORDER.O_ERROR:
                renew_Link()

        match Order:
            case ORDER.O_STOP:
                if FIXED("MAIN-stop-keeps-reference"):
                    write_T_REF(addressof(Rest))
                write_STATUS(STATUS.STOP)

            case ORDER.O_MISSION:
                if FIXED("MAIN-reference-outlives"):
                    write_T_REF(addressof(Rest))
                write_STATUS(STATUS.MISSION)

            case ORDER.O_TELEMANIPULATION:
                write_STATUS(STATUS.TELEMANIPULATION)

            case ORDER.O_SETR:
                if FIXED("MAIN-reference-outlives"):
                    if read_STATUS() == STATUS.TELEMANIPULATION:
                        Obtain_Reference(Order_frame, addressof(Local_ref))
                        write_T_REF(addressof(Local_ref))
                else:
                    Obtain_Reference(Order_frame, addressof(Local_ref))

                    write_T_REF(addressof(Local_ref))
            case ORDER.O_CALIBRATION:
                if FIXED("MAIN-reference-outlives"):
                    write_T_REF(addressof(Rest))
                write_STATUS(STATUS.CALIBRATION)

            case ORDER.O_INITIALITATION:
                if FIXED("MAIN-init-reference"):
                    write_T_REF(addressof(Rest))
                write_STATUS(STATUS.INITIALITATION)

            case _:
                pass


# main_Robot.c: TaskODO
def TaskODO(a0: UArg, a1: UArg) -> void:
    if FIXED("MAIN-odo-race") or FIXED("MAIN-odo-commanded"):
        moved: REFERENCE = (0.0, 0.0)
    if FIXED("MAIN-link-silent") or FIXED("MAIN-distance-unchecked") or FIXED("MAIN-front-stuck") or FIXED("GYRO-answer-unchecked") or FIXED("MAIN-turn-unchecked") or FIXED("MAIN-wheel-unchecked") or FIXED("MAIN-bumper-stuck") or FIXED("MAIN-push-unnoticed"):  # noqa: E501
        seen: uint16

    if FIXED("MAIN-clock-before-task"):
        Clock_start(clockTaskODO)
    while 1:
        Semaphore_pend(TaskODO_sem, BIOS_WAIT_FOREVER)

        read_ODO_Trayect(addressof(odoT))
        if FIXED("MAIN-init-odometry"):
            if take_ODO_Reset():
                odoT.X = 0
                odoT.Y = 0
                odoT.tita = 0
        if FIXED("MAIN-odo-commanded"):
            moved.V = take_Way() * 1000 / Odometry_Period
            moved.W = take_ODO_Turn() * 1000 / Odometry_Period
        elif FIXED("MAIN-odo-race"):
            read_REF(addressof(moved))
        if FIXED("MAIN-odo-race"):
            Odom_Trayect(
                addressof(odoT), moved.V, moved.W, read_front_distance(), read_left_distance(),
                read_right_distance(), Odometry_Period,
            )
        elif FIXED("MAIN-odo-commanded"):
            Odom_Trayect(addressof(odoT), moved.V, moved.W, df, dl, dr, Odometry_Period)
        else:
            Odom_Trayect(addressof(odoT), Robot_Reference_N.V, Robot_Reference_N.W, df, dl, dr, Odometry_Period)
        if FIXED("MAIN-distance-unchecked"):
            odoT.df = Told(odoT.df)
            odoT.dl = Told(odoT.dl)
            odoT.dr = Told(odoT.dr)
        if FIXED("MAIN-link-silent") or FIXED("MAIN-distance-unchecked") or FIXED("MAIN-front-stuck") or FIXED("GYRO-answer-unchecked") or FIXED("MAIN-turn-unchecked") or FIXED("MAIN-wheel-unchecked") or FIXED("MAIN-bumper-stuck") or FIXED("MAIN-push-unnoticed"):  # noqa: E501
            seen = read_Seen()
            if seen > SEEN_NO_DISTANCE:  # that stands in its own place
                odoT.df = -float32(seen)
        write_ODO_Trayect(addressof(odoT))
        Send_ODO_Trayect(addressof(odoT))


# main_Robot.c: TaskODO
def Told(distance: float32) -> float32:
    return distance if Known(distance) else -1.0


# main_Robot.c: Inicializa
def write_ODO_Reset() -> void:
    key: IArg

    key = GateMutexPri_enter(Way_server)
    ODO_Reset = 1
    GateMutexPri_leave(Way_server, key)


# main_Robot.c: TaskODO
def take_ODO_Reset() -> uint16:
    reset: uint16
    key: IArg

    key = GateMutexPri_enter(Way_server)
    reset = ODO_Reset
    ODO_Reset = 0
    GateMutexPri_leave(Way_server, key)
    return reset


# main_Robot.c: MISION_4
def MISION_4() -> void:
    if FIXED("MAIN-bumper-stuck"):
        if bumper != 0:
            Pressed_Count = 0
        elif Pressed_Count == PRESSED_PERIODS:
            Action(0, 0)
            return
        else:
            Pressed_Count = Pressed_Count + 1
    if FIXED("US-poll-forever") or FIXED("US-dead-sonar") or FIXED("US-implausible"):
        if df < 0 or dl < 0 or dr < 0:
            Action(0, 0)  # a sonar has no reading: the robot stands until it has one
            return
    if FIXED("MAIN-turn-not-kept") or FIXED("MAIN-blind-spot") or FIXED("MAIN-bump-repeats") or FIXED("MAIN-push-unnoticed"):  # noqa: E501
        if Turn_deg != 0 and bumper != 0:
            Turn()
            return
    if FIXED("MAIN-bump-repeats") or FIXED("MAIN-push-unnoticed"):
        if bumper != 0 and Bumped == 1:
            Back_Off()
            return
    if bumper == 0:

        Position(0, 0)

        caso2 = caso2 + 1

        if caso2 > 60:
            Position(0, -0.1)
            if FIXED("MAIN-bump-repeats"):
                Bumped = 1
                Reverse_Count = 0

    else:
        if df < (40 if FIXED("MAIN-safety-distance") else 45):

            Position(0, 0)
            EstadoNav = ESTADO_NAV.FRENTE

            if df < 25:
                caso2 = caso2 + 1
            else:
                caso = caso + 1

        elif df < 60:

            if FIXED("MAIN-side-correction") or FIXED("MAIN-ciego-unused"):
                Straight_On(0.1)
            else:
                Position(0, 0.1)
            EstadoNav = ESTADO_NAV.SIGUE

            caso = 0
            caso2 = 0
            if FIXED("MAIN-reverse-unbounded"):
                Reverse_Count = 0

            if not FIXED("MAIN-side-correction"):
                if dl < 30 and dr > 30:
                    Position(-2, 0.1)
                if dr < 30 and dl > 30:
                    Position(2, 0.1)

        else:

            if FIXED("MAIN-side-correction") or FIXED("MAIN-ciego-unused"):
                Straight_On(0.15)
            else:
                Position(0, 0.15)
            EstadoNav = ESTADO_NAV.SIGUE

            caso = 0
            caso2 = 0
            if FIXED("MAIN-reverse-unbounded"):
                Reverse_Count = 0

            if not FIXED("MAIN-side-correction"):
                if dl < 30 and dr > 30:
                    Position(-2, 0.15)
                if dr < 30 and dl > 30:
                    Position(2, 0.15)

        if FIXED("MAIN-blind-spot"):
            Look_Out()

    if (caso > 60 and bumper != 0) if FIXED("MAIN-bump-turn") else caso > 60:

        if not FIXED("MAIN-state-surrounded"):
            EstadoNav = ESTADO_NAV.RODEADO

        if dl > dr:
            Position(89, 0 if FIXED("MAIN-turn-moving") else 0.1)
            EstadoNav = ESTADO_NAV.IZQUIERDA
            if FIXED("MAIN-turn-not-kept"):
                Begin_Turn(89)

        elif dr >= dl if FIXED("MAIN-equal-distances") else dr > dl:
            Position(-89, 0 if FIXED("MAIN-turn-moving") else 0.1)
            EstadoNav = ESTADO_NAV.DERECHA
            if FIXED("MAIN-turn-not-kept"):
                Begin_Turn(-89)

    if caso2 > 60:

        if FIXED("MAIN-state-surrounded"):
            EstadoNav = ESTADO_NAV.RODEADO
        Position(0, -0.1)
        if FIXED("MAIN-reverse-unbounded"):
            Reverse_Count = Reverse_Count + 1
            if Reverse_Count > REVERSE_LIMIT:
                Position(0, 0)
                caso = 61
                caso2 = 0
                Reverse_Count = 0


# main_Robot.c: MISION_4
def Begin_Turn(deg: float32) -> void:
    Turn_deg = deg
    Turned_rad = 0
    Turn_Count = 0


# main_Robot.c: MISION_4
def Turn() -> void:
    left_deg: float32

    if FIXED("MAIN-heading"):
        Turned_rad = tita_abs
    else:
        Turned_rad = Turned_rad + wZ * (Navigation_Period / 1000.0)
    Turn_Count = Turn_Count + 1
    left_deg = Turn_deg - Turned_rad / RAD_PER_DEG
    if Turn_deg < 0:
        left_deg = -left_deg
    if left_deg <= TURN_DONE_DEG or Turn_Count > TURN_LIMIT:
        if FIXED("MAIN-heading"):
            tita_abs = tita_abs - Turn_deg * RAD_PER_DEG  # straight on is the new direction from here on
        if FIXED("MAIN-null-integrators"):
            Ix[0] = 0
        Turn_deg = 0
        caso = 0
        caso2 = 0
        Position(0, 0)
    else:
        Position(Turn_deg, 0.1 if FIXED("MAIN-turn-not-kept") and not FIXED("MAIN-turn-moving") else 0)


# main_Robot.c: MISION_4
def Back_Off() -> void:
    Reverse_Count = Reverse_Count + 1
    Position(0, -0.1)
    if Reverse_Count > BUMP_REVERSE:
        Bumped = 0
        Reverse_Count = 0
        caso2 = 0
        Begin_Turn(89 if dl > dr else -89)


# main_Robot.c: MISION_4
def Look_Out() -> void:
    Lost_F = Lost_F + 1 if df > NO_ECHO_CM else 0
    Lost_L = Lost_L + 1 if dl > NO_ECHO_CM else 0
    Lost_R = Lost_R + 1 if dr > NO_ECHO_CM else 0
    if Lost_F == 0 or Lost_L == 0 or Lost_R == 0:
        Heard = 1
    if Heard == 1 and Lost_F >= NO_ECHO_PERIODS and Lost_L >= NO_ECHO_PERIODS and Lost_R >= NO_ECHO_PERIODS:
        Position(0, 0)
        Begin_Turn(45 if Lost_L > Lost_R else -45)
        Heard = 0  # once: a hall wider than the sonars reach is crossed straight on


# main_Robot.c: MISION_4
def Straight_On(V: float32) -> void:
    deg: float32 = 0.0

    if FIXED("MAIN-side-correction"):
        deg = rectifica(dl, dr)
    if FIXED("MAIN-ciego-unused"):
        deg = deg + Lean()
    Position(deg, V)


# main_Robot.c: MISION_4
if FIXED("MAIN-ciego-unused"):  # else it would call P_ciego, and nothing else does

    def Lean() -> float32:
        near: float32
        side: uint16

        side = 1 if dl < dr else 0
        near = dl if dl < dr else dr
        if side != Ciego_Side:
            Ciego_Side = side
            cont = 0
            d_ciego_dt = 0
        Wciego = P_ciego(near, 2, 60, 15)
        if Wciego < 0:
            return -LEAN_DEG if dl < dr else LEAN_DEG
        return 0


# main_Robot.c: rectifica
def rectifica(distL: float32, distR: float32) -> float32:
    deg: float32 = 0.0

    if distL < SIDE_CM:
        deg = deg - (SIDE_CM - distL)
    if distR < SIDE_CM:
        deg = deg + (SIDE_CM - distR)
    if deg > SIDE_LIMIT_DEG:
        deg = SIDE_LIMIT_DEG
    if deg < -SIDE_LIMIT_DEG:
        deg = -SIDE_LIMIT_DEG
    return deg


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
        xenc[0] = xenc[0] + ki * err * (Navigation_Period / 1000.0 if FIXED("MAIN-pi-period") else Tsw)

    return pi


# main_Robot.c: Comp
def Comp(i: int16, dF_ant: float32) -> float32:
    dF_act: float32
    if FIXED("MAIN-comp-undefined"):
        X: float32 = 0.0
    else:
        X: float32
    V: float32

    if i > 50:

        dF_act = read_front_distance() if FIXED("MAIN-comp-unit") else float32(Read_Channel(1))
        X = ((dF_ant - dF_act) if FIXED("MAIN-comp-sign") else (dF_act - dF_ant)) / 100
    if X <= 0:
        V = 0
    else:

        V = X / (COMP_SPAN_S if FIXED("MAIN-comp-span") else 5)

    return V


# main_Robot.c: CalibGyro
def CalibGyro(tiempo: float32) -> void:
    t: float32 = tiempo * 20 + CALIB_REST if FIXED("MAIN-calib-span") else tiempo * 20
    if cuenta_gyro > t:

        if FIXED("MAIN-calib-task"):
            write_Calib_Request(CALIB_FINISH)
        elif FIXED("MAIN-calib-span"):
            finish_Calib()
        elif FIXED("GYRO-offset-moving"):
            measure_Offset()
        else:
            vZ_b = Offset_GYRO(GYRO_SENSOR.Z)
        cuenta_gyro = 0
        if FIXED("MAIN-calib-repeats"):
            end_CALIBRATION()
    else:
        if FIXED("MAIN-calib-span") and FIXED("MAIN-calib-task"):
            write_Calib_Request(CALIB_BEGIN if cuenta_gyro < CALIB_REST else CALIB_READ)
        elif FIXED("MAIN-calib-span"):
            if cuenta_gyro < CALIB_REST:
                begin_Calib()
            else:
                add_Calib(getZ())
        cuenta_gyro += 1


# main_Robot.c: CalibGyro
def end_CALIBRATION() -> void:
    key: IArg

    key = GateMutexPri_enter(Status_server)
    if ROBOT_Status == STATUS.CALIBRATION:  # another order may have come
        ROBOT_Status = STATUS.STOP
    GateMutexPri_leave(Status_server, key)


# main_Robot.c: Lineal_velocity
def Lineal_velocity() -> void:

    if Cuenta_US < 10:
        if FIXED("MAIN-hidden-names"):
            dF_lineal = read_front_distance()
        else:
            dF_ant = read_front_distance()
    if Cuenta_US > 50:

        if (25 < df and df < 90 if FIXED("MAIN-lineal-range") else (25 < df) < 90) and (
            fabs(wZ) <= 1 if FIXED("MAIN-lineal-turning") else wZ <= 1
        ):

            V_comp = Comp(Cuenta_US, dF_lineal if FIXED("MAIN-hidden-names") else dF_ant)

            hayComp = 1
        else:
            V_comp = 0
            Cuenta_US = 0
            hayComp = 0
        Cuenta_US = 0

    else:
        Cuenta_US += 1

    V_pi = PI(Robot_Reference_S.V, V_comp, kp_V, ki_V, Iv, 0.3, -0.3)
    Action(V_pi, Robot_Reference_N.W if FIXED("MAIN-lineal-straightens") else 0)


# main_Robot.c: velocity
def velocity(Wref: float32, Vlineal: float32) -> void:
    if not FIXED("MAIN-hidden-names"):
        Wpi: float32 = 0

    Wpi = PI(
        Wref if FIXED("MAIN-velocity-reference") else Robot_Reference_S.W, wZ,
        kp_W if FIXED("MAIN-hidden-names") else kp, ki_W if FIXED("MAIN-hidden-names") else ki, Iw, 0.5, -0.5,
    )
    Action(Vlineal, Wpi)


# main_Robot.c: Position
def Position(titaref: float32, Vlineal: float32) -> void:
    tita_ref: float32
    if not FIXED("MAIN-hidden-names"):
        Wpos: float32
    if not FIXED("MAIN-position-count"):
        cont_pos: float32 = 0

    tita_ref = titaref * (RAD_PER_DEG if FIXED("MAIN-position-radians") else 0.0174)

    cont_pos = cont_pos + 1
    if cont_pos >= 60:
        Wpos = 0
        cont_pos = 0
    else:
        Wpos = PI(tita_ref, tita_abs, kpx, kix, Ix, 1.57, -1.57)

    Action(Vlineal, Wpos)


# main_Robot.c: P_ciego
def P_ciego(us: float32, t: int16, dmax: float32, dmin: float32) -> float32:
    d_act: float32 = 0
    if not FIXED("MAIN-ciego-forgets"):
        d_ant: float32 = 0
    dt: float32
    if FIXED("MAIN-ciego-overflow"):
        temp: int32 = 0
        temp = int32(t) * 20
    else:
        temp: int16 = 0
        temp = t * 20

    if FIXED("MAIN-ciego-zero"):
        if temp <= 0:
            return 0
    if FIXED("MAIN-ciego-limits"):
        if us > dmax or us < dmin:
            cont = 0
            d_ciego_dt = 0
            return 0
    if FIXED("MAIN-ciego-forgets"):
        if cont == 0:
            d_ciego_ant = us
        cont += 1
        if cont > temp:
            cont = 0
            d_act = us
            d_ciego_dt = (d_act - d_ciego_ant) / temp
        dt = d_ciego_dt
    else:
        if cont >= temp:

            cont = 0
        else:
            d_act = us
            cont += 1

        dt = (d_act - d_ant) / temp

        d_ant = d_act

    return dt


# main_Robot.c: Inicializa
def Inicializa() -> void:

    caso = 0
    caso2 = 0
    caso3 = 0
    cuenta_gyro = 0
    if not FIXED("MAIN-speed-control-unused"):
        Cuenta_US = 0
    if not FIXED("MAIN-init-distances"):
        dl = 0
        df = 0
        dr = 0
    if not FIXED("MAIN-init-others"):
        Left_distance = 0
        Front_distance = 0
        Right_distance = 0

    Ti = 0
    siguiente = 0
    periodo = 0
    j = 0

    vX_b = 0
    vY_b = 0
    if not FIXED("MAIN-init-offset"):
        vZ_b = 0
    wZ = 0
    Wabs = 0

    if FIXED("MAIN-init-pointer"):
        Ix[0] = 0
    else:
        Ix = 0
    tita_abs = 0
    Wpos = 0
    if not FIXED("MAIN-titaref-unread"):
        titaref = 0
    if not FIXED("MAIN-init-others"):
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

    if not FIXED("MAIN-speed-control-unused"):
        V_comp = 0
        if FIXED("MAIN-hidden-names"):
            dF_lineal = 0
        else:
            dF_ant = 0
        V_pi = 0
        hayComp = 0
    if FIXED("MAIN-init-odometry"):
        write_ODO_Reset()


if FIXED("MAIN-speed-control-unused"):
    del Lineal_velocity, velocity, Comp
    del kp_V, ki_V, Iv, Iw, Wpi, V_comp, V_pi, hayComp, Cuenta_US
    if FIXED("MAIN-hidden-names"):
        del kp_W, ki_W
    else:
        del kp, ki
    if FIXED("MAIN-hidden-names"):
        del dF_lineal
    else:
        del dF_ant
