"""servidores.c with its defects corrected, each where its id stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from emulator.c28x.language import *
from emulator.sysbios.headers import (
    GateMutexPri_create,
    GateMutexPri_enter,
    GateMutexPri_leave,
    GateMutexPri_Params_init,
    IArg,
)
from firmware_model.robot_types import ODOMETRY_Trayect
from firmware_model.servidores import ROBOT_df, ROBOT_dl, ROBOT_dr, ROBOT_Odometry, ROBOT_Odometry_T

if TYPE_CHECKING:
    from firmware_model.servidores import (
        Odometry_server,
        Odometry_Trayect_server,
        US_server,
        prms,
    )

# The two distances of a measurement that wait for the third, and the two of a reading that were taken with the first.
New_dl: float32 = 0.0
New_df: float32 = 0.0
Read_dl: float32 = 0.0
Read_dr: float32 = 0.0

if FIXED("SERV-unused-object"):
    del ROBOT_Odometry
if FIXED("SERV-trayect-gate"):
    del Odometry_server


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
    if not FIXED("SERV-trayect-gate"):
        GateMutexPri_Params_init(addressof(prms))
        Odometry_server = GateMutexPri_create(addressof(prms), NULL)
    GateMutexPri_Params_init(addressof(prms))
    Odometry_Trayect_server = GateMutexPri_create(addressof(prms), NULL)


# servidores.c: write_left_distance
def write_left_distance(d: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(US_server)
    if FIXED("SERV-distances-apart"):
        New_dl = d
    else:
        ROBOT_dl = d
    GateMutexPri_leave(US_server, key)


# servidores.c: write_front_distance
def write_front_distance(d: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(US_server)
    if FIXED("SERV-distances-apart"):
        New_df = d
    else:
        ROBOT_df = d
    GateMutexPri_leave(US_server, key)


# servidores.c: write_right_distance
def write_right_distance(d: float32) -> void:
    key: IArg

    key = GateMutexPri_enter(US_server)
    if FIXED("SERV-distances-apart"):  # the right one comes last: now the measurement is whole
        ROBOT_dl = New_dl
        ROBOT_df = New_df
    ROBOT_dr = d
    GateMutexPri_leave(US_server, key)


# servidores.c: read_left_distance
def read_left_distance() -> float32:
    d: float32
    key: IArg

    key = GateMutexPri_enter(US_server)
    if FIXED("SERV-distances-apart"):
        d = Read_dl
    else:
        d = ROBOT_dl
    GateMutexPri_leave(US_server, key)
    return d


# servidores.c: read_front_distance
def read_front_distance() -> float32:
    d: float32
    key: IArg

    key = GateMutexPri_enter(US_server)
    d = ROBOT_df
    if FIXED("SERV-distances-apart"):  # the front one is asked for first: the other two go with it
        Read_dl = ROBOT_dl
        Read_dr = ROBOT_dr
    GateMutexPri_leave(US_server, key)
    return d


# servidores.c: read_right_distance
def read_right_distance() -> float32:
    d: float32
    key: IArg

    key = GateMutexPri_enter(US_server)
    if FIXED("SERV-distances-apart"):
        d = Read_dr
    else:
        d = ROBOT_dr
    GateMutexPri_leave(US_server, key)
    return d


# servidores.c: write_ODO_Trayect
def write_ODO_Trayect(dataT: ptr[ODOMETRY_Trayect]) -> void:
    key: IArg

    key = GateMutexPri_enter(Odometry_Trayect_server if FIXED("SERV-trayect-gate") else Odometry_server)
    ROBOT_Odometry_T.X = dataT.X
    ROBOT_Odometry_T.Y = dataT.Y
    ROBOT_Odometry_T.tita = dataT.tita
    ROBOT_Odometry_T.df = dataT.df
    ROBOT_Odometry_T.dr = dataT.dr
    ROBOT_Odometry_T.dl = dataT.dl

    GateMutexPri_leave(Odometry_Trayect_server if FIXED("SERV-trayect-gate") else Odometry_server, key)


# servidores.c: read_ODO_Trayect
def read_ODO_Trayect(dataT: ptr[ODOMETRY_Trayect]) -> void:
    key: IArg

    key = GateMutexPri_enter(Odometry_Trayect_server if FIXED("SERV-trayect-gate") else Odometry_server)
    dataT.X = ROBOT_Odometry_T.X
    dataT.Y = ROBOT_Odometry_T.Y
    dataT.tita = ROBOT_Odometry_T.tita

    dataT.df = ROBOT_Odometry_T.df
    dataT.dr = ROBOT_Odometry_T.dr
    dataT.dl = ROBOT_Odometry_T.dl

    GateMutexPri_leave(Odometry_Trayect_server if FIXED("SERV-trayect-gate") else Odometry_server, key)
