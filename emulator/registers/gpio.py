"""GPIO control and data registers, ports A to F.  TRM chapter GPIO; HDR F2837xS_gpio.h.

GpioCtrlRegs at 0x7C00 is EALLOW protected in full, GpioDataRegs at 0x7F00 is not protected.  The ports differ only
in the numbers of their pins (port F ends at GPIO168, port B has an analog mode), so the fields of a register are
made by one factory from the pin that stands at bit 0, and the blocks list every register by name and offset.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from emulator.registers.core import R0W1, RW, W1S, Access, At, Block, F, Register

#: GPIO0 .. GPIO168.
PIN_COUNT: Final = 169
PORTS: Final = "ABCDEF"


class PinRegister(Register):
    """A register with one field `GPIOn` a pin (or QUALPRDn for eight pins)."""

    if TYPE_CHECKING:  # The factory makes the fields, so a type checker cannot list them.

        def __getattr__(self, name: str) -> int: ...
        def __setattr__(self, name: str, value: object) -> None: ...


def _register(fields: dict[str, F], eallow: bool) -> type[PinRegister]:
    register: type[PinRegister] = type("PinRegister", (PinRegister,), dict(fields), bits=32, eallow=eallow)
    return register


def pins(first: int, width: int, access: Access, reset: int, text: str, *,
         eallow: bool = True, modelled: bool = True) -> type[PinRegister]:  # fmt: skip
    """A 32-bit register with a field of `width` bits for each pin from GPIO`first` on."""
    fields = {
        f"GPIO{pin}": F(width * (pin - first) + width - 1, width * (pin - first), access, reset, f"{text} of GPIO{pin}",
                        modelled=modelled)
        for pin in range(first, min(first + 32 // width, PIN_COUNT))
    }  # fmt: skip
    return _register(fields, eallow)


def periods(first: int) -> type[PinRegister]:
    """GPxCTRL: the sampling period of eight pins a field."""
    groups = (min(32, PIN_COUNT - first) + 7) // 8
    fields = {
        f"QUALPRD{n}": F(8 * n + 7, 8 * n, RW, 0, f"sampling period from GPIO{first + 8 * n}: 0 = SYSCLK, n = 2n SYSCLK")
        for n in range(groups)
    }
    return _register(fields, eallow=True)


def qualification(first: int) -> type[PinRegister]:
    """GPxQSELn: 0 synchronous, 1 three samples, 2 six samples, 3 asynchronous."""
    return pins(first, 2, RW, 0, "input qualification")


def mux(first: int) -> type[PinRegister]:
    """GPxMUXn: lower half of the peripheral select; 0 is GPIO."""
    return pins(first, 2, RW, 0, "peripheral select")


def group_mux(first: int) -> type[PinRegister]:
    """GPxGMUXn: upper half of the peripheral select."""
    return pins(first, 2, RW, 0, "peripheral group select")


def direction(first: int) -> type[PinRegister]:
    """GPxDIR: 1 = output."""
    return pins(first, 1, RW, 0, "direction")


def pull_up_disable(first: int) -> type[PinRegister]:
    """GPxPUD: 1 = no pull-up.  CHOICE: all pull-ups are off after reset (unconfirmed)."""
    return pins(first, 1, RW, 1, "pull-up disable")


def inversion(first: int) -> type[PinRegister]:
    """GPxINV: 1 = the input is inverted."""
    return pins(first, 1, RW, 0, "input inversion")


def open_drain(first: int) -> type[PinRegister]:
    """GPxODR: 1 = open-drain output."""
    return pins(first, 1, RW, 0, "open drain")


def core_select(first: int) -> type[PinRegister]:
    """GPxCSELn: 0 = CPU1 owns the output, 1 = its CLA."""
    return pins(first, 4, RW, 0, "owner of the output", modelled=False)


def lock(first: int) -> type[PinRegister]:
    """GPxLOCK: 1 = the configuration of the pin is frozen."""
    return pins(first, 1, RW, 0, "configuration lock")


def commit(first: int) -> type[PinRegister]:
    """GPxCR: 1 = the lock bit is frozen until reset."""
    return pins(first, 1, W1S, 0, "lock commit")


def data(first: int) -> type[PinRegister]:
    """GPxDAT: reads pins, writes output latches."""
    return pins(first, 1, RW, 0, "data", eallow=False)


def action(first: int) -> type[PinRegister]:
    """GPxSET, GPxCLEAR, GPxTOGGLE: 1 acts on the output latch.  CHOICE: reads 0 (unconfirmed)."""
    return pins(first, 1, R0W1, 0, "output latch action", eallow=False)


class GPBAMSEL(Register, bits=32, eallow=True):
    """Analog mode of the USB pins."""

    #           bits           type  reset  description
    GPIO43 = F( 11,            RW,   0,     "analog mode of GPIO43", modelled=False)
    GPIO42 = F( 10,            RW,   0,     "analog mode of GPIO42", modelled=False)


class GpioCtrlRegs(Block, struct="GPIO_CTRL_REGS"):
    """Configuration of all pins."""

    # port A: GPIO0 to GPIO31
    GPACTRL   = At(0x000, periods(0))
    GPAQSEL1  = At(0x002, qualification(0))
    GPAQSEL2  = At(0x004, qualification(16))
    GPAMUX1   = At(0x006, mux(0))
    GPAMUX2   = At(0x008, mux(16))
    GPADIR    = At(0x00A, direction(0))
    GPAPUD    = At(0x00C, pull_up_disable(0))
    GPAINV    = At(0x010, inversion(0))
    GPAODR    = At(0x012, open_drain(0))
    GPAGMUX1  = At(0x020, group_mux(0))
    GPAGMUX2  = At(0x022, group_mux(16))
    GPACSEL1  = At(0x028, core_select(0))
    GPACSEL2  = At(0x02A, core_select(8))
    GPACSEL3  = At(0x02C, core_select(16))
    GPACSEL4  = At(0x02E, core_select(24))
    GPALOCK   = At(0x03C, lock(0))
    GPACR     = At(0x03E, commit(0))

    # port B: GPIO32 to GPIO63
    GPBCTRL   = At(0x040, periods(32))
    GPBQSEL1  = At(0x042, qualification(32))
    GPBQSEL2  = At(0x044, qualification(48))
    GPBMUX1   = At(0x046, mux(32))
    GPBMUX2   = At(0x048, mux(48))
    GPBDIR    = At(0x04A, direction(32))
    GPBPUD    = At(0x04C, pull_up_disable(32))
    GPBINV    = At(0x050, inversion(32))
    GPBODR    = At(0x052, open_drain(32))
    GPBAMSEL  = At(0x054, GPBAMSEL)
    GPBGMUX1  = At(0x060, group_mux(32))
    GPBGMUX2  = At(0x062, group_mux(48))
    GPBCSEL1  = At(0x068, core_select(32))
    GPBCSEL2  = At(0x06A, core_select(40))
    GPBCSEL3  = At(0x06C, core_select(48))
    GPBCSEL4  = At(0x06E, core_select(56))
    GPBLOCK   = At(0x07C, lock(32))
    GPBCR     = At(0x07E, commit(32))

    # port C: GPIO64 to GPIO95
    GPCCTRL   = At(0x080, periods(64))
    GPCQSEL1  = At(0x082, qualification(64))
    GPCQSEL2  = At(0x084, qualification(80))
    GPCMUX1   = At(0x086, mux(64))
    GPCMUX2   = At(0x088, mux(80))
    GPCDIR    = At(0x08A, direction(64))
    GPCPUD    = At(0x08C, pull_up_disable(64))
    GPCINV    = At(0x090, inversion(64))
    GPCODR    = At(0x092, open_drain(64))
    GPCGMUX1  = At(0x0A0, group_mux(64))
    GPCGMUX2  = At(0x0A2, group_mux(80))
    GPCCSEL1  = At(0x0A8, core_select(64))
    GPCCSEL2  = At(0x0AA, core_select(72))
    GPCCSEL3  = At(0x0AC, core_select(80))
    GPCCSEL4  = At(0x0AE, core_select(88))
    GPCLOCK   = At(0x0BC, lock(64))
    GPCCR     = At(0x0BE, commit(64))

    # port D: GPIO96 to GPIO127
    GPDCTRL   = At(0x0C0, periods(96))
    GPDQSEL1  = At(0x0C2, qualification(96))
    GPDQSEL2  = At(0x0C4, qualification(112))
    GPDMUX1   = At(0x0C6, mux(96))
    GPDMUX2   = At(0x0C8, mux(112))
    GPDDIR    = At(0x0CA, direction(96))
    GPDPUD    = At(0x0CC, pull_up_disable(96))
    GPDINV    = At(0x0D0, inversion(96))
    GPDODR    = At(0x0D2, open_drain(96))
    GPDGMUX1  = At(0x0E0, group_mux(96))
    GPDGMUX2  = At(0x0E2, group_mux(112))
    GPDCSEL1  = At(0x0E8, core_select(96))
    GPDCSEL2  = At(0x0EA, core_select(104))
    GPDCSEL3  = At(0x0EC, core_select(112))
    GPDCSEL4  = At(0x0EE, core_select(120))
    GPDLOCK   = At(0x0FC, lock(96))
    GPDCR     = At(0x0FE, commit(96))

    # port E: GPIO128 to GPIO159
    GPECTRL   = At(0x100, periods(128))
    GPEQSEL1  = At(0x102, qualification(128))
    GPEQSEL2  = At(0x104, qualification(144))
    GPEMUX1   = At(0x106, mux(128))
    GPEMUX2   = At(0x108, mux(144))
    GPEDIR    = At(0x10A, direction(128))
    GPEPUD    = At(0x10C, pull_up_disable(128))
    GPEINV    = At(0x110, inversion(128))
    GPEODR    = At(0x112, open_drain(128))
    GPEGMUX1  = At(0x120, group_mux(128))
    GPEGMUX2  = At(0x122, group_mux(144))
    GPECSEL1  = At(0x128, core_select(128))
    GPECSEL2  = At(0x12A, core_select(136))
    GPECSEL3  = At(0x12C, core_select(144))
    GPECSEL4  = At(0x12E, core_select(152))
    GPELOCK   = At(0x13C, lock(128))
    GPECR     = At(0x13E, commit(128))

    # port F: GPIO160 to GPIO168
    GPFCTRL   = At(0x140, periods(160))
    GPFQSEL1  = At(0x142, qualification(160))
    GPFMUX1   = At(0x146, mux(160))
    GPFDIR    = At(0x14A, direction(160))
    GPFPUD    = At(0x14C, pull_up_disable(160))
    GPFINV    = At(0x150, inversion(160))
    GPFODR    = At(0x152, open_drain(160))
    GPFGMUX1  = At(0x160, group_mux(160))
    GPFCSEL1  = At(0x168, core_select(160))
    GPFCSEL2  = At(0x16A, core_select(168))
    GPFLOCK   = At(0x17C, lock(160))
    GPFCR     = At(0x17E, commit(160))


class GpioDataRegs(Block, struct="GPIO_DATA_REGS"):
    """Levels and latches of all pins."""

    GPADAT    = At(0x00, data(0))
    GPASET    = At(0x02, action(0))
    GPACLEAR  = At(0x04, action(0))
    GPATOGGLE = At(0x06, action(0))

    GPBDAT    = At(0x08, data(32))
    GPBSET    = At(0x0A, action(32))
    GPBCLEAR  = At(0x0C, action(32))
    GPBTOGGLE = At(0x0E, action(32))

    GPCDAT    = At(0x10, data(64))
    GPCSET    = At(0x12, action(64))
    GPCCLEAR  = At(0x14, action(64))
    GPCTOGGLE = At(0x16, action(64))

    GPDDAT    = At(0x18, data(96))
    GPDSET    = At(0x1A, action(96))
    GPDCLEAR  = At(0x1C, action(96))
    GPDTOGGLE = At(0x1E, action(96))

    GPEDAT    = At(0x20, data(128))
    GPESET    = At(0x22, action(128))
    GPECLEAR  = At(0x24, action(128))
    GPETOGGLE = At(0x26, action(128))

    GPFDAT    = At(0x28, data(160))
    GPFSET    = At(0x2A, action(160))
    GPFCLEAR  = At(0x2C, action(160))
    GPFTOGGLE = At(0x2E, action(160))
