"""Assur groups that can be solved, one file a type. A new type is a file and a line here."""

from tmm_cli.groups.base import Dyad
from tmm_cli.groups.prp import PRP
from tmm_cli.groups.rpp import RPP
from tmm_cli.groups.rpr import RPR
from tmm_cli.groups.rrp import RRP
from tmm_cli.groups.rrr import RRR

KERNELS: dict[str, type[Dyad]] = {kernel.type: kernel for kernel in (RRR, RRP, RPR, PRP, RPP)}
