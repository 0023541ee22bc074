"""Adapters of us.c, GYRO.c, Odometry.c and protocol.c."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from emulator.c28x.objects import Structure
from emulator.c28x.runtime import EndlessPoll
from hil.golden.bench import GUARD_COMMA, LastAccess, VectorBench
from hil.golden.scripted_gyro import OUT_TEMP
from hil.golden.values import to_bits, to_float, to_floats

Given = Mapping[str, Any]
Out = dict[str, Any]

#: Sensor index -> what Read_Distance calls its window and its accumulator, and the SOC that it uses.
SENSORS: Final = {0: ("v", "result"), 1: ("vF", "resultF"), 2: ("vR", "resultR")}
CALIBRATIONS: Final = ("L", "F", "R")
TRAYECT: Final = ("X", "Y", "tita", "df", "dr", "dl")
GPIO69: Final = 1 << 5
CTRL_REG1, CTRL_REG4, CTRL_REG5 = 0x20, 0x23, 0x24


def start_adc(bench: VectorBench) -> None:
    """What TaskUS does first."""
    bench.fw.us.Init_US()
    bench.delays.clear()


# us.c


def init_us(bench: VectorBench, given: Given) -> Out:
    """Registers as little-endian bytes; GPIO69 at each delay."""
    blocks = bench.board.blocks
    adc = blocks["AdcaRegs"].registers
    direction = blocks["GpioCtrlRegs"].registers["GPCDIR"]
    for name, value in zip(("ADCCTL1", "ADCCTL2"), given["pre"], strict=True):
        adc[name].value = value
    # The vectors' DAT is what was written last; the chip's DAT reads 32 pins.
    with LastAccess(bench, ("GpioDataRegs", "GPCDAT")) as written:
        bench.on_delay = lambda us: [us, int(direction.value & GPIO69 != 0), int(written.word & GPIO69 != 0)]
        bench.fw.us.Init_US()
    return {
        "ADCCTL1": adc["ADCCTL1"].value,
        "ADCCTL2": adc["ADCCTL2"].value,
        **{f"SOC{n}": adc[f"ADCSOC{n}CTL"].value.to_bytes(4, "little").hex() for n in range(3)},
        "PCLKCR13": blocks["CpuSysRegs"].registers["PCLKCR13"].value,
        "GPCDIR": (direction.value & GPIO69).to_bytes(4, "little").hex(),
        "GPCDAT": (written.word & GPIO69).to_bytes(4, "little").hex(),
        "delays_us_dir_dat": list(bench.delays),
        "total_us": sum(delay[0] for delay in bench.delays),
    }


def calibrate_us(bench: VectorBench, given: Given) -> Out:
    """The calls, then one Read_Distance a sensor with the same conversions."""
    us = bench.fw.us
    start_adc(bench)
    for sensor, slope, bias in given["calls"]:
        us.Calibrate_US(sensor, to_float(slope), to_float(bias))
    distances = []
    for sensor, (window, accumulator) in SENSORS.items():
        bench.fw.initial(f"us.Read_Distance.{accumulator}", 0.0)
        bench.fw.plant(f"us.Read_Distance.{window}", 65535, 0.0)
        bench.convert(given["adc"])
        distances.append(us.Read_Distance(sensor))
    return {
        "m": [getattr(us, f"{side}_Calib_m") for side in CALIBRATIONS],
        "b": [getattr(us, f"{side}_Calib_b") for side in CALIBRATIONS],
        "distances": distances,
    }


def read_channel(bench: VectorBench, given: Given) -> Out:
    """One conversion; a poll that nothing can end is the fault "hang".

    The ADC of the vectors obeys a write at the next access of a register.  So where the driver's last access is the
    acknowledgement (a channel without a result) they show the write still pending and the flag still set.
    """
    start_adc(bench)
    adc = bench.board.adc["A"]
    registers = bench.board.blocks["AdcaRegs"].registers
    bench.convert([given["adc"]])
    adc.stopped_by_fault = given["adc_dead"]
    registers["ADCINTFLG"].value = given["flag_before"]
    try:
        with LastAccess(bench, ("AdcaResultRegs", "ADCRESULT"), ("AdcaRegs", "ADCINTFLGCLR")) as last:
            value = bench.fw.us.Read_Channel(given["CH"])
    except EndlessPoll:
        return {"fault": "hang"}
    finally:
        adc.stopped_by_fault = False
    pending = last.word if last.name == "ADCINTFLGCLR" else registers["ADCINTFLGCLR"].read()
    return {
        "value": value,
        "channels": list(bench.converted),
        "INTSEL1N2": registers["ADCINTSEL1N2"].value,
        "INTFLG_after_ack": registers["ADCINTFLG"].value | pending,
        "pending_CLR": pending,
    }


def read_distance(bench: VectorBench, given: Given) -> Out:
    """Twelve conversions; accumulator and the cell of index 65535 start as stated."""
    fw, sensor = bench.fw, given["sensor_index"]
    start_adc(bench)
    if given["calibrated"]:
        for side in CALIBRATIONS:
            setattr(fw.us, f"{side}_Calib_m", to_float(given["slope"]))
            setattr(fw.us, f"{side}_Calib_b", to_float(given["bias"]))
    window, accumulator = SENSORS.get(sensor, SENSORS[0])
    fw.initial(f"us.Read_Distance.{accumulator}", to_float(given["result0"]))
    fw.plant(f"us.Read_Distance.{window}", 65535, to_float(given["v_minus_1"]))
    bench.convert(given["adc"])
    distance = fw.us.Read_Distance(sensor)
    converted = list(bench.converted)
    out: Out = {"distance": distance, "conversions": len(converted), "channels": sorted(set(converted))}
    if sensor in SENSORS:
        out["v_minus_1_after"] = fw.planted(f"us.Read_Distance.{window}", 65535)
        out["v_after"] = fw.last_locals("us.Read_Distance")[window]
    return out


def median(bench: VectorBench, given: Given) -> Out:
    """`v` with what lies behind it; `aux` has more room than in the C."""
    n, fill = given["n"], to_float(given["aux_fill"])
    bench.fw.initial("us.median.aux", fill)
    v = bench.array("float32", [*to_floats(given["v"]), *[to_float(given["beyond"])] * (n + 1)])
    result = bench.fw.us.median(v, n)
    # A slot that memcpy did not reach still holds the fill (as "never written").
    copied = [x is not None and to_bits(x) != given["aux_fill"] for x in bench.fw.last_locals("us.median")["aux"]]
    return {"result": result, "floats_copied": sum(copied), "aux_slots_past_20_written": sum(copied[20:])}


def average(bench: VectorBench, given: Given) -> Out:
    """The accumulator starts as stated."""
    bench.fw.initial("us.average.result", to_float(given["result0"]))
    return {"result": bench.fw.us.average(bench.array("float32", to_floats(given["v"])), given["n"])}


# GYRO.c


def start_gyro(bench: VectorBench, given: Given) -> None:
    """SPI-A and chip select ready, the offset as stated."""
    bench.fw.spi.Init_SPIA()
    bench.fw.gyro.Z_dc_offset = given.get("Z_dc_offset", 0)
    bench.gyro.forget()
    bench.delays.clear()


def init_gyro(bench: VectorBench, given: Given) -> Out:
    """Calls one after the other: the accumulator is not cleared between them."""
    calls = []
    for raws in given["raw_per_call"]:
        bench.gyro.forget()
        bench.delays.clear()
        bench.gyro.script_axis(2, raws)
        bench.fw.gyro.Init_GYRO()
        gyro, registers = bench.fw.gyro, bench.gyro.registers
        calls.append({
            "Z_dc_offset": gyro.Z_dc_offset,
            "aux": gyro.aux,
            "i": gyro.i,
            "buff_0_49_99": [gyro.buff[0], gyro.buff[49], gyro.buff[99]],
            "spi_bytes": len(bench.gyro.mosi),
            "spi_first_20": bench.gyro.mosi[:20].hex(),
            "delay_us": sum(bench.delays),
            "CTRL_REG1": f"{registers[CTRL_REG1]:02x}",
            "CTRL_REG4": f"{registers[CTRL_REG4]:02x}",
            "CTRL_REG5": f"{registers[CTRL_REG5]:02x}",
        })  # fmt: skip
    return {"calls": calls}


def get_xyz(bench: VectorBench, given: Given) -> Out:
    """One axis; `spi_high_byte` is what an SPI driver that does not mask would add."""
    bench = bench.unmasked(given.get("spi_high_byte", 0))
    start_gyro(bench, given)
    axis = given["axis"]
    bench.gyro.set_axis("XYZ".index(axis), given["raw"])
    setattr(bench.fw.gyro, f"{axis}_Calib_b", to_float(given["Calib_b"]))
    value = getattr(bench.fw.gyro, f"get{axis}")()
    return {"value": value, "spi_mosi": bench.gyro.mosi.hex()}


def get_temp(bench: VectorBench, given: Given) -> Out:
    """OUT_TEMP as an 8-bit register."""
    start_gyro(bench, given)
    bench.gyro.registers[OUT_TEMP] = given["raw"]
    return {"value": bench.fw.gyro.getTemp()}


def write_reg(bench: VectorBench, given: Given) -> Out:
    """Write and read back; `junk` is what an SPI driver that does not mask would add."""
    bench = bench.unmasked(given["junk"])
    start_gyro(bench, given)
    ret = bench.fw.gyro.writeReg(given["reg"], given["value"])
    return {"ret": ret, "mosi": bench.gyro.mosi.hex(), "delay": sum(bench.delays)}


def offset_gyro(bench: VectorBench, given: Given) -> Out:
    """The mean of fifty readings."""
    start_gyro(bench, given)
    bench.fw.initial("gyro.Offset_GYRO.bias_Gyro", to_float(given["bias0"]))
    bench.gyro.script_axis(min(given["axis_index"], 2), given["raw"])
    bias = bench.fw.gyro.Offset_GYRO(given["axis_index"])
    return {"bias": bias, "reads": bench.gyro.reads}


def get_gyro(bench: VectorBench, given: Given) -> Out:
    """One reading in rad/s."""
    start_gyro(bench, given)
    bench.fw.initial("gyro.get_GYRO.Wabs", to_float(given["Wabs0"]))
    for axis in range(3):
        bench.gyro.set_axis(axis, given["raw"])
    return {"W": bench.fw.gyro.get_GYRO(given["axis_index"], to_float(given["bias"]))}


# Odometry.c


def trayect(bench: VectorBench, values: list[str]) -> Structure:
    """An ODOMETRY_Trayect with the members in the order of the structure."""
    return bench.structure("ODOMETRY_Trayect", **dict(zip(TRAYECT, to_floats(values), strict=True)))


def odom_trayect(bench: VectorBench, given: Given) -> Out:
    """The structure after each step."""
    state = trayect(bench, given["state0"])
    period = to_float(given["Tcontrol"])
    steps = []
    for step in given["steps"]:
        bench.fw.odometry.Odom_Trayect(state, *to_floats(step), period)
        steps.append([getattr(state, name) for name in TRAYECT])
    return {"steps": steps, "titamax": bench.fw.odometry.titamax}


# protocol.c


def interpret_order(bench: VectorBench, given: Given) -> Out:
    """The buffer behind the frame is zero."""
    protocol = bench.fw.protocol
    order = protocol.Interpret_Order(bench.array("char", [*given["chars"], *[0] * 8]))
    return {"order": protocol.ORDER.name(order)}


def obtain_reference(bench: VectorBench, given: Given) -> Out:
    """The frame over stale content, and a comma far behind both."""
    chars, stale = given["chars"], given["stale"]
    frame = [*chars, *stale[len(chars) :]]
    behind = [ord(","), *[0] * 8]
    data = bench.array("char", [*frame, *[0] * (GUARD_COMMA - len(frame)), *behind])
    reference = bench.structure("REFERENCE", V=0.0, W=0.0)
    bench.fw.protocol.Obtain_Reference(data, reference)
    j = bench.fw.protocol.Move_to_comma(5, data)
    return {
        "V": reference.V,
        "W": reference.W,
        "j": j,
        "scan_left_the_frame": j >= len(chars),
        "scan_left_the_200_word_buffer": j >= 200,
    }


def send_odo_trayect(bench: VectorBench, given: Given) -> Out:
    """The frame as handed to the XBee driver."""
    bench.fw.protocol.Send_ODO_Trayect(trayect(bench, [given[name] for name in TRAYECT]))
    return {"n": len(bench.frames[0]), "frame": bench.frames[0]}


ADAPTERS: Final[dict[str, Callable[[VectorBench, Given], Out]]] = {
    "Init_US": init_us,
    "Calibrate_US": calibrate_us,
    "Read_Channel": read_channel,
    "Read_Distance": read_distance,
    "median": median,
    "average": average,
    "Init_GYRO": init_gyro,
    "getXYZ": get_xyz,
    "getTemp": get_temp,
    "writeReg": write_reg,
    "Offset_GYRO": offset_gyro,
    "get_GYRO": get_gyro,
    "Odom_Trayect": odom_trayect,
    "Interpret_Order": interpret_order,
    "Obtain_Reference": obtain_reference,
    "Send_ODO_Trayect": send_odo_trayect,
}
