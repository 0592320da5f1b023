-- A store of schema 2: mug1 and pose1 at 1 s; on1 and on2 say at 2 s that something is on mug1, on1
-- again at 3 s, on2 is removed at 4 s; on1 and pose1 once more in the imagined episode 1 at 6 s.
PRAGMA application_id = 1212764741;
PRAGMA user_version = 2;
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE word(          -- concepts, relations, types of values
  id INTEGER PRIMARY KEY,
  text TEXT NOT NULL UNIQUE);
INSERT INTO word VALUES(1,'Mug');
INSERT INTO word VALUES(2,'hasColour');
INSERT INTO word VALUES(3,'xsd:string');
INSERT INTO word VALUES(4,'hasPose');
INSERT INTO word VALUES(5,'Pose');
INSERT INTO word VALUES(6,'hasX');
INSERT INTO word VALUES(7,'xsd:float');
INSERT INTO word VALUES(8,'On');
INSERT INTO word VALUES(9,'hasObject');
INSERT INTO word VALUES(10,'hasArea');
INSERT INTO word VALUES(11,'Area');
CREATE TABLE instance(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE COLLATE NOCASE);
INSERT INTO instance VALUES(1,'mug1');
INSERT INTO instance VALUES(2,'pose1');
INSERT INTO instance VALUES(3,'on1');
INSERT INTO instance VALUES(4,'on2');
CREATE TABLE instance_concept(  -- which concepts an instance ever had
  concept INTEGER NOT NULL,
  instance INTEGER NOT NULL,
  PRIMARY KEY(concept, instance)) WITHOUT ROWID;
INSERT INTO instance_concept VALUES(1,1);
INSERT INTO instance_concept VALUES(5,2);
INSERT INTO instance_concept VALUES(8,3);
INSERT INTO instance_concept VALUES(8,4);
CREATE TABLE validity(
  id INTEGER PRIMARY KEY,           -- sequence number of the change that opened it
  instance INTEGER NOT NULL,
  world INTEGER NOT NULL,           -- 0 the real one, else the imagined episode
  concept INTEGER NOT NULL,
  source INTEGER NOT NULL,
  updated INTEGER NOT NULL,         -- 1: it took the place of `previous`
  episode INTEGER NOT NULL,
  previous INTEGER NOT NULL,        -- validity of the same instance and world before, or 0
  closed INTEGER NOT NULL,          -- sequence number of the change that ended it, or 2^63 - 1
  level INTEGER,                    -- of the index by time; NULL: holds at no time
  start_earliest REAL NOT NULL,
  start_latest REAL NOT NULL,
  finish_earliest REAL NOT NULL,    -- as it stands: as given, or since when it is closed
  finish_latest REAL NOT NULL,
  given_earliest REAL,              -- finish as given; NULL: for ever
  given_latest REAL,
  ended_before REAL NOT NULL,       -- latest finish of all earlier validities of the same instance
  properties BLOB NOT NULL);
INSERT INTO validity VALUES(1,1,0,1,1,0,0,0,9223372036854775807,6000,1.0,1.0,1e999,1e999,NULL,NULL,-1e999,X'0202030004626c756504050005706f736531');
INSERT INTO validity VALUES(2,2,0,5,1,0,0,0,9223372036854775807,6000,1.0,1.0,1e999,1e999,NULL,NULL,-1e999,X'01060701000000000000e03f');
INSERT INTO validity VALUES(3,3,0,8,1,0,0,0,5,1,2.0,2.0,3.0,3.0,NULL,NULL,-1e999,X'02090100046d7567310a0b00056172656131');
INSERT INTO validity VALUES(4,4,0,8,1,0,0,0,6,2,2.0,2.0,4.0,4.0,NULL,NULL,-1e999,X'02090100046d7567310a0b00056172656132');
INSERT INTO validity VALUES(5,3,0,8,1,1,0,3,9223372036854775807,6000,3.0,3.0,1e999,1e999,NULL,NULL,3.0,X'02090100044d7567310a0b00056172656132');
INSERT INTO validity VALUES(7,3,1,8,1,0,1,0,9223372036854775807,6000,6.0,6.0,1e999,1e999,NULL,NULL,-1e999,X'02090100046d7567310a0b00056172656133');
INSERT INTO validity VALUES(8,2,1,5,1,0,1,0,9223372036854775807,6000,6.0,6.0,1e999,1e999,NULL,NULL,-1e999,X'01060701000000000000f83f');
CREATE TABLE removal(
  sequence INTEGER PRIMARY KEY,
  validity INTEGER NOT NULL,
  time REAL NOT NULL,
  episode INTEGER NOT NULL,
  source INTEGER NOT NULL);
INSERT INTO removal VALUES(6,4,4.0,0,1);
CREATE TABLE filler(        -- validities by hash of role and text
  hash INTEGER NOT NULL,
  validity INTEGER NOT NULL,
  PRIMARY KEY(hash, validity)) WITHOUT ROWID;
INSERT INTO filler VALUES(-5353630707873414588,7);
INSERT INTO filler VALUES(-5353629608361786377,4);
INSERT INTO filler VALUES(-5353629608361786377,5);
INSERT INTO filler VALUES(-5353628508850158166,3);
INSERT INTO filler VALUES(-904334610088420367,3);
INSERT INTO filler VALUES(-904334610088420367,4);
INSERT INTO filler VALUES(-904334610088420367,5);
INSERT INTO filler VALUES(-904334610088420367,7);
INSERT INTO filler VALUES(-275361279284520120,1);
INSERT INTO filler VALUES(2716663770646506762,1);
CREATE TABLE episode(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  task TEXT NOT NULL,
  outcome TEXT NOT NULL,
  imagined INTEGER NOT NULL,
  parent INTEGER NOT NULL,
  start REAL NOT NULL,
  finish REAL NOT NULL);
INSERT INTO episode VALUES(1,'1970-01-01T00:00:05','Serve guest1','',1,0,5.0,1e999);
CREATE INDEX validity_of ON validity(instance, world, start_earliest);
CREATE INDEX validity_when ON
  validity(world, level, start_earliest, finish_latest, instance, concept);
CREATE INDEX validity_in ON validity(episode, id) WHERE episode <> 0;
COMMIT;
