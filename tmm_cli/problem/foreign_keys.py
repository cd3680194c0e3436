"""Keys of problem files as they are called in Russian and Serbian: who writes one of these is told the key."""

from __future__ import annotations

from typing import Final

_WORDS: Final = {
    "title": "название заголовок naslov naziv",
    "description": "описание opis",
    "units": "единицы jedinice",
    "parameters": "параметры parametri",
    "synthesis": "синтез sinteza",
    "points": "точки tačke tacke",
    "guides": "направляющие vođice vodice",
    "links": "звенья članovi clanovi чланови",
    "link": "звено član clan члан",
    "driver": "привод двигатель pogon",
    "gears": "колёса колеса шестерни zupčanici zupcanici",
    "racks": "рейки letve",
    "cams": "кулачки bregovi",
    "springs": "пружины opruge",
    "friction": "трение trenje",
    "sketch": "эскиз схема skica",
    "masses": "массы mase",
    "mass": "масса masa",
    "loads": "нагрузки силы opterećenja opterecenja",
    "gravity": "тяжесть gravitacija",
    "output": "выход izlaz",
    "positions": "положения položaji polozaji",
    "checks": "проверки provere",
    "length": "длина dužina duzina",
    "name": "имя ime",
    "speed": "скорость brzina",
    "slides": "скользит ползун klizi klizač",
    "along": "вдоль duž duz",
    "angle": "угол ugao",
    "force": "сила sila",
    "moment": "момент moment",
    "weight": "вес težina tezina",
    "inertia": "инерция inercija",
    "centre": "центр centar težište",
    "count": "число количество broj",
    "turns": "вращение smer",
    "task": "задача zadatak",
}
FOREIGN: Final = {word: key for key, words in _WORDS.items() for word in words.split()}
