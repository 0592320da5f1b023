-- A store of schema 1: mug1 and pose1 at 1 s, pose1 moved at 10, 20 and 30 s in episode 1.
PRAGMA application_id = 1212764741;
PRAGMA user_version = 1;
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
CREATE TABLE instance(
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE COLLATE NOCASE);
INSERT INTO instance VALUES(1,'mug1');
INSERT INTO instance VALUES(2,'pose1');
CREATE TABLE instance_concept(  -- which concepts an instance ever had
  concept INTEGER NOT NULL,
  instance INTEGER NOT NULL,
  PRIMARY KEY(concept, instance)) WITHOUT ROWID;
INSERT INTO instance_concept VALUES(1,1);
INSERT INTO instance_concept VALUES(5,2);
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
INSERT INTO validity VALUES(2,2,0,5,1,0,0,0,3,4,1.0,1.0,10.0,10.0,NULL,NULL,-1e999,X'01060701000000000000e03f');
INSERT INTO validity VALUES(3,2,0,5,1,1,1,2,4,4,10.0,10.0,20.0,20.0,NULL,NULL,10.0,X'01060701000000000000f83f');
INSERT INTO validity VALUES(4,2,0,5,1,1,1,3,5,4,20.0,20.0,30.0,30.0,NULL,NULL,20.0,X'010607010000000000000440');
INSERT INTO validity VALUES(5,2,0,5,1,1,1,4,9223372036854775807,6000,30.0,30.0,1e999,1e999,NULL,NULL,30.0,X'010607010000000000000c40');
CREATE TABLE removal(
  sequence INTEGER PRIMARY KEY,
  validity INTEGER NOT NULL,
  time REAL NOT NULL,
  episode INTEGER NOT NULL,
  source INTEGER NOT NULL);
CREATE TABLE filler(        -- validities by hash of role and text
  hash INTEGER NOT NULL,
  validity INTEGER NOT NULL,
  PRIMARY KEY(hash, validity)) WITHOUT ROWID;
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
INSERT INTO episode VALUES(1,'1970-01-01T00:00:05','Serve guest1','',0,0,5.0,1e999);
CREATE INDEX validity_of ON validity(instance, world, start_earliest);
CREATE INDEX validity_when ON
  validity(world, level, start_earliest, finish_latest, instance, concept);
COMMIT;
