"""servidores.c: the monitors that the tasks share, each behind a mutex with priority inheritance.

Sources: TFG section 3.1.5, annex 1.
"""

from __future__ import annotations

from emulator.c28x.language import *
from emulator.sysbios.headers import (
    GateMutexPri_create,
    GateMutexPri_enter,
    GateMutexPri_Handle,
    GateMutexPri_leave,
    GateMutexPri_Params,
    GateMutexPri_Params_init,
    IArg,
)
from firmware_model.robot_types import ODOMETRY, REFERENCE, STATUS, ODOMETRY_Trayect

ROBOT_Status: STATUS = STATUS.STOP
Telemanipulation_Reference: REFERENCE = (0.0, 0.0)
Status_server: GateMutexPri_Handle

ROBOT_dl: float32 = 0.0
ROBOT_df: float32 = 0.0
ROBOT_dr: float32 = 0.0
US_server: GateMutexPri_Handle

ROBOT_wz: float32 = 0.0
GYRO_server: GateMutexPri_Handle

ROBOT_Reference: REFERENCE = (0.0, 0.0)
Reference_server: GateMutexPri_Handle

ROBOT_Odometry: ODOMETRY = (0.0, 0.0, 0.0)
Odometry_server: GateMutexPri_Handle

ROBOT_Odometry_T: ODOMETRY_Trayect = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
Odometry_Trayect_server: GateMutexPri_Handle

prms: GateMutexPri_Params


# servidores.c: Server_Create
def Server_Create() -> void:

    GateMutexPri_Params_init(addressof(prms))
    Status_server = GateMutexPri_create(addressof(prms), NULL)
    GateMutexPri_Params_init(addressof(prms))
    US_server = GateMutexPri_create(addressof(prms), NULL)
    GateMutexPri_Params_init(addressof(prms))
    GYRO_server = GateMutexPri_create(addressof(prms), NULL)
    GateMutexPri_Params_init(addressof(prms))
    Reference_server = GateMutexPri_create(addressof(prms), NULL)
    GateMutexPri_Params_init(addressof(prms))
    Odometry_server = GateMutexPri_create(addressof(prms), NULL)
    GateMutexPri_Params_init(addressof(prms))
    Odometry_Trayect_server = GateMutexPri_create(addressof(prms), NULL)


# servidores.c: write_STATUS
def write_STATUS(st: STATUS) -> void:
    key: IArg

    key = GateMutexPri_enter(Status_server)
    ROBOT_Status = st
    GateMutexPri_leave(Status_server, key)


# servidores.c: read_STATUS
def read_STATUS() -> STATUS:
    key: IArg
    aux_st: STATUS

    key = GateMutexPri_enter(Status_server)
    aux_st = ROBOT_Status
    GateMutexPri_leave(Status_server, key)
    return aux_st


# servidores.c: write_T_REF
def write_T_REF(ref: ptr[REFERENCE]) -> void:
    key: IArg

    key = GateMutexPri_enter(Status_server)
    Telemanipulation_Reference.V = ref.V
    Telemanipulation_Reference.W = ref.W
    GateMutexPri_leave(Status_server, key)


# servidores.c: read_T_REF
def read_T_REF(ref: ptr[REFERENCE]) -> void:
    key: IArg

    key = GateMutexPri_enter(Status_server)

    ref.V = Telemanipulation_Reference.V
    ref.W = Telemanipulation_Reference.W
    GateMutexPri_leave(Status_server, key)


# servidores.c: write_left_distance
def write_left_distance(d: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(US_server)
    ROBOT_dl = d
    GateMutexPri_leave(US_server, key)


# servidores.c: write_front_distance
def write_front_distance(d: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(US_server)
    ROBOT_df = d
    GateMutexPri_leave(US_server, key)


# servidores.c: write_right_distance
def write_right_distance(d: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(US_server)
    ROBOT_dr = d
    GateMutexPri_leave(US_server, key)


# servidores.c: read_left_distance
def read_left_distance() -> float32:
    d: float32
    key: IArg

    key = GateMutexPri_enter(US_server)
    d = ROBOT_dl
    GateMutexPri_leave(US_server, key)
    return d


# servidores.c: read_front_distance
def read_front_distance() -> float32:
    d: float32
    key: IArg

    key = GateMutexPri_enter(US_server)
    d = ROBOT_df
    GateMutexPri_leave(US_server, key)
    return d


# servidores.c: read_right_distance
def read_right_distance() -> float32:
    d: float32
    key: IArg

    key = GateMutexPri_enter(US_server)
    d = ROBOT_dr
    GateMutexPri_leave(US_server, key)
    return d


# servidores.c: write_z_axis
def write_z_axis(d: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    ROBOT_wz = d
    GateMutexPri_leave(GYRO_server, key)


# servidores.c: read_z_axis
def read_z_axis() -> float32:
    d: float32
    key: IArg

    key = GateMutexPri_enter(GYRO_server)
    d = ROBOT_wz
    GateMutexPri_leave(GYRO_server, key)
    return d


# servidores.c: write_REF
def write_REF(ref: ptr[REFERENCE]) -> void:
    key: IArg

    key = GateMutexPri_enter(Reference_server)
    ROBOT_Reference.V = ref.V
    ROBOT_Reference.W = ref.W
    GateMutexPri_leave(Reference_server, key)


# servidores.c: read_REF
def read_REF(ref: ptr[REFERENCE]) -> void:
    key: IArg

    key = GateMutexPri_enter(Reference_server)
    ref.V = ROBOT_Reference.V
    ref.W = ROBOT_Reference.W
    GateMutexPri_leave(Reference_server, key)


# servidores.c: write_ODO_Trayect
def write_ODO_Trayect(dataT: ptr[ODOMETRY_Trayect]) -> void:
    key: IArg

    key = GateMutexPri_enter(Odometry_server)  # as in C: not Odometry_Trayect_server
    ROBOT_Odometry_T.X = dataT.X
    ROBOT_Odometry_T.Y = dataT.Y
    ROBOT_Odometry_T.tita = dataT.tita
    ROBOT_Odometry_T.df = dataT.df
    ROBOT_Odometry_T.dr = dataT.dr
    ROBOT_Odometry_T.dl = dataT.dl

    GateMutexPri_leave(Odometry_server, key)


# servidores.c: read_ODO_Trayect
def read_ODO_Trayect(dataT: ptr[ODOMETRY_Trayect]) -> void:
    key: IArg

    key = GateMutexPri_enter(Odometry_server)
    dataT.X = ROBOT_Odometry_T.X
    dataT.Y = ROBOT_Odometry_T.Y
    dataT.tita = ROBOT_Odometry_T.tita

    dataT.df = ROBOT_Odometry_T.df
    dataT.dr = ROBOT_Odometry_T.dr
    dataT.dl = ROBOT_Odometry_T.dl

    GateMutexPri_leave(Odometry_server, key)
